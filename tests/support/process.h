// A program as its user starts it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/real_data.h"

namespace maploop::testing {

struct ProcessResult {
  int status = -1;  // exit status; 128 + n after signal n
  std::string out;
  std::string error;
};

// Starts at construction; ends with the object, by force if need be.
class Process {
 public:
  explicit Process(const std::vector<std::string>& command);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send_signal(int signal) const;
  ProcessResult wait();

 private:
  TemporaryFolder folder_;  // of its output
  pid_t id_ = 0;
};

// The `maploop` command of the build that the running test belongs to.
std::string maploop_command();

// Waits until a file, which another process writes, contains a text; false where it does not within
// a minute.
bool comes_to_contain(const std::filesystem::path& file, const std::string& text);

inline ProcessResult run(const std::vector<std::string>& command) {
  return Process(command).wait();
}

}  // namespace maploop::testing
