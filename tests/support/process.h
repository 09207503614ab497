// Runs a program as its user starts it.
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

// A Process starts at construction and ends with the object, by force if needed.
class Process {
 public:
  explicit Process(const std::vector<std::string>& command);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send_signal(int signal) const;
  bool runs() const;  // until it has ended; wait() returns its result
  ProcessResult wait();

 private:
  TemporaryFolder folder_;  // contains its output
  pid_t id_ = 0;
};

// Returns the `maploop` command of the build to which the running test belongs.
std::string maploop_command();

// Waits until a file that another process writes contains `text` so many times; returns false if it
// does not within a minute.
bool comes_to_contain(const std::filesystem::path& file, const std::string& text, int times = 1);

inline ProcessResult run(const std::vector<std::string>& command) {
  return Process(command).wait();
}

}  // namespace maploop::testing
