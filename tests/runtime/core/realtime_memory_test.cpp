#include "runtime/core/realtime_memory.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <thread>

#include "runtime/core/realtime.h"
#include "runtime/core/realtime_text.h"
#include "runtime/core/thread.h"
#include "tests/runtime/core/realtime_child.h"

// The sanitizers replace malloc and mlockall.
#define MAPLOOP_REQUIRE_PLAIN_BUILD() \
  if (MAPLOOP_SANITIZED)              \
  GTEST_SKIP() << "SKIPPED, NOT TESTED: a sanitizer replaces the memory calls"

namespace maploop::runtime {
namespace {

using ::testing::HasSubstr;

std::string in_words(const RealtimeSetting& s) {
  return std::string(to_string(s.verdict)) + '|' + s.granted + '|' + s.reason;
}

long minor_faults() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt;
}

std::int64_t locked_kb() {
  const std::string status = read_system_file("/proc/self/status").value_or("");
  return parse_integer(line_value(status, "VmLck").value_or("")).value_or(-1);
}

TEST(RealtimeMemory, TheHeapIsMappedAndKept) {
  MAPLOOP_REQUIRE_PLAIN_BUILD();
  EXPECT_EQ(in_child([] {
              const auto settings =
                  prepare_memory({.lock_memory = false, .heap_mb = 32, .malloc_arenas = 1}, {});
              if (settings.size() != 1) return std::string("one item expected");
              // Buffers allocated and freed afterwards use these pages, on other threads too.
              long faults = 0;
              std::thread([&faults] {
                constexpr std::size_t image_bytes = 4 << 20;
                std::free(std::malloc(64));
                const long before = minor_faults();
                for (int i = 0; i < 10; ++i) {
                  auto* image = static_cast<volatile char*>(std::malloc(image_bytes));
                  for (std::size_t byte = 0; byte < image_bytes; byte += 4096) image[byte] = 1;
                  std::free(const_cast<char*>(image));
                }
                faults = minor_faults() - before;
              }).join();
              return in_words(settings[0]) +
                     (faults < 10 ? "" : "|faults " + std::to_string(faults));
            }),
            "granted|32 MB mapped and kept|");
}

TEST(RealtimeMemory, AHeapBeyondTheLimitIsRefused) {
  MAPLOOP_REQUIRE_PLAIN_BUILD();
  const std::string text = in_child([] {
    const rlimit limit{256 << 20, 256 << 20};
    setrlimit(RLIMIT_AS, &limit);
    return in_words(
        prepare_memory({.lock_memory = false, .heap_mb = 1024, .malloc_arenas = 1}, {}).at(0));
  });
  EXPECT_EQ(text, "refused|0 MB mapped and kept|there is not so much memory for this process");
}

TEST(RealtimeMemory, NothingAskedNothingDone) {
  EXPECT_TRUE(prepare_memory({.lock_memory = false, .heap_mb = 0, .malloc_arenas = 1}, {}).empty());
}

TEST(RealtimeMemory, AsRootAllIsLockedAndWhatComesTooAsItIsTouched) {
  MAPLOOP_REQUIRE_ROOT();
  MAPLOOP_REQUIRE_PLAIN_BUILD();
  if (!read_privileges().ipc_lock) GTEST_SKIP() << "SKIPPED, NOT TESTED: root without CAP_IPC_LOCK";
  EXPECT_EQ(in_child([] {
              const auto settings = prepare_memory(
                  {.lock_memory = true, .heap_mb = 8, .malloc_arenas = 1}, read_privileges());
              const std::int64_t before = locked_kb();
              constexpr std::size_t tested_bytes = 16 << 20;
              void* later = mmap(nullptr, tested_bytes, PROT_READ | PROT_WRITE,
                                 MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
              unsigned char first_page = 1;
              mincore(later, 4096, &first_page);
              const bool future =
                  locked_kb() - before >= static_cast<std::int64_t>(tested_bytes / 1024);
              return std::string(to_string(settings.at(1).verdict)) +
                     (before >= 8 * 1024 ? " locked" : " not locked") +
                     (future ? " future" : " not future") +
                     ((first_page & 1) == 0 ? " untouched" : " touched");
            }),
            "granted locked future untouched");
}

TEST(RealtimeMemory, AnOrdinaryUserWithASmallLimitIsRefusedAndMayStillAllocate) {
  MAPLOOP_REQUIRE_PLAIN_BUILD();
  const ChildLimits limits;
  MAPLOOP_REQUIRE_ORDINARY_USER(limits);
  const std::string text = as_ordinary_user(limits, [] {
    const auto settings =
        prepare_memory({.lock_memory = true, .heap_mb = 8, .malloc_arenas = 1}, read_privileges());
    void* large = std::malloc(64 << 20);
    const bool allocated = large != nullptr;
    std::free(large);
    return in_words(settings.at(1)) + (allocated ? "|allocated" : "|not allocated");
  });
  EXPECT_EQ(text.substr(0, 16), "refused|0 kB of ");
  EXPECT_THAT(text, HasSubstr("|no CAP_IPC_LOCK, and RLIMIT_MEMLOCK is 64 kB|allocated"));
}

TEST(RealtimeMemory, WithALimitThatSufficesNowWhatComesIsNotLocked) {
  MAPLOOP_REQUIRE_ROOT();
  MAPLOOP_REQUIRE_PLAIN_BUILD();
  Privileges limited;  // as an ordinary user's; the kernel itself would allow root more
  limited.memlock = std::uint64_t{1} << 30;
  EXPECT_EQ(
      in_child([&limited] {
        const RealtimeSetting setting =
            prepare_memory({.lock_memory = true, .heap_mb = 0, .malloc_arenas = 1}, limited).at(0);
        const std::int64_t before = locked_kb();
        void* large = std::malloc(64 << 20);
        const bool unlocked = large != nullptr && locked_kb() - before < 1024;
        std::free(large);
        return std::string(to_string(setting.verdict)) + '|' + setting.reason +
               (before > 0 ? "|locked" : "|not locked") + (unlocked ? "" : "|later too");
      }),
      "refused|no CAP_IPC_LOCK, and RLIMIT_MEMLOCK is 1048576 kB: what comes is not "
      "locked|locked");
}

TEST(RealtimeMemory, AStackIsMappedBeforeItIsUsed) {
  Scheduling scheduling;
  scheduling.prefaulted_stack_kb = 512;
  long faults = -1;
  Thread thread(
      "thread", scheduling, {},
      [&](const std::stop_token&) {
        const long before = minor_faults();
        volatile char memory[400 * 1024];
        for (std::size_t i = 0; i < sizeof memory; i += 4096) memory[i] = 1;
        faults = minor_faults() - before;
      },
      [] {});
  thread.join();
  const RealtimeSetting setting = thread.settings().at(1);
  EXPECT_EQ(setting.name, "thread: stack");
  EXPECT_EQ(setting.granted, "512 kB mapped");
  EXPECT_EQ(setting.verdict, Verdict::granted) << setting.reason;
  if (!MAPLOOP_SANITIZED) {
    EXPECT_LE(faults, 2) << "100 pages were used";
  }
}

TEST(RealtimeMemory, MoreStackThanThereIsIsRefusedNotFatal) {
  Scheduling scheduling;
  scheduling.prefaulted_stack_kb = 1 << 20;
  Thread thread(
      "thread", scheduling, {}, [](const std::stop_token&) {}, [] {});
  thread.join();
  const RealtimeSetting setting = thread.settings().at(1);
  EXPECT_EQ(setting.verdict, Verdict::refused);
  EXPECT_THAT(setting.reason, HasSubstr("the stack has "));
  EXPECT_NE(setting.granted, "0 kB mapped");
}

TEST(RealtimeMemory, ANegativeStackIsRefused) {
  const RealtimeSetting setting = prefault_stack("thread", -1);
  EXPECT_EQ(setting.verdict, Verdict::refused);
  EXPECT_EQ(setting.reason, "a size must not be negative");
}

TEST(RealtimeMemory, TheMainThreadsStackGrows) {
  EXPECT_EQ(in_words(prefault_stack("main", 1024)), "granted|1024 kB mapped|");
}

TEST(RealtimeProcess, EveryItemIsInTheReportWithARemedyWhereItIsNotGranted) {
  const std::string text = in_child([] {
    const RealtimeReport report =
        prepare_process({.lock_memory = true, .heap_mb = 4, .malloc_arenas = 1});
    for (const char* name :
         {"heap", "locked memory", "real-time CPU time", "kernel", "real-time throttling",
          "CPU frequency", "virtual machine", "isolated CPUs"}) {
      if (report.find(name) == nullptr) return std::string("missing: ") + name;
    }
    for (const RealtimeSetting& setting : report.settings) {
      const bool granted = setting.verdict == Verdict::granted;
      if (setting.granted.empty() || setting.asked.empty()) return setting.name + ": empty";
      if (granted != setting.reason.empty() || granted != setting.remedy.empty()) {
        return setting.name + ": reason and remedy";
      }
      if (setting.remedy.find('\n') != std::string::npos) return setting.name + ": lines";
    }
    return std::string("complete");
  });
  EXPECT_EQ(text, "complete");
}

}  // namespace
}  // namespace maploop::runtime
