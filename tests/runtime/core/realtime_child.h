// This file runs a function in a child process that gives up its privileges.
#pragma once

#include <grp.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <string>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MAPLOOP_SANITIZED 1
#else
#define MAPLOOP_SANITIZED 0
#endif

#define MAPLOOP_REQUIRE_ROOT() \
  if (geteuid() != 0)          \
  GTEST_SKIP() << "SKIPPED, NOT TESTED: run the tests as root to see what root is granted"

namespace maploop::runtime {

// These are the limits of an ordinary user; they are hard ones, so that they also hold for root
// without capabilities.
struct ChildLimits {
  rlim_t rtprio = 0;
  rlim_t nice = 0;
  rlim_t memlock = 64 * 1024;
};

// Returns the result of `body` in a child process, or "child failed". The child does not outlive
// the call.
inline std::string in_child(const std::function<std::string()>& body) {
  int ends[2];
  if (pipe(ends) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    const std::string text = body();
    const bool written = write(ends[1], text.data(), text.size()) >= 0;
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  std::string text;
  char part[4096];
  for (ssize_t n; (n = read(ends[0], part, sizeof part)) > 0;) {
    text.append(part, static_cast<std::size_t>(n));
  }
  close(ends[0]);
  int status = 0;
  if (waitpid(child, &status, 0) != child || status != 0) return "child failed after: " + text;
  return text;
}

// Does the same as user and group 65534 (nobody) without capabilities, or as the present user if
// that is an ordinary one.
inline std::string as_ordinary_user(const ChildLimits& limits,
                                    const std::function<std::string()>& body) {
  return in_child([&]() -> std::string {
    const auto limit = [](__rlimit_resource resource, rlim_t value) {
      const rlimit both{value, value};
      return setrlimit(resource, &both) == 0;
    };
    if (!limit(RLIMIT_RTPRIO, limits.rtprio) || !limit(RLIMIT_NICE, limits.nice) ||
        !limit(RLIMIT_MEMLOCK, limits.memlock)) {
      return "limits refused";
    }
    constexpr unsigned nobody_id = 65534;
    if (geteuid() == 0 &&
        (setgroups(0, nullptr) != 0 || setresgid(nobody_id, nobody_id, nobody_id) != 0 ||
         setresuid(nobody_id, nobody_id, nobody_id) != 0)) {
      return "user refused";
    }
    return body();
  });
}

}  // namespace maploop::runtime

// Skips if this machine does not let the test become an ordinary user with those limits.
#define MAPLOOP_REQUIRE_ORDINARY_USER(limits)                                                   \
  if (const std::string dropped = as_ordinary_user(limits, [] { return std::string("done"); }); \
      dropped != "done")                                                                        \
  GTEST_SKIP() << "SKIPPED, NOT TESTED: cannot become an ordinary user here: " << dropped
