// Writes an LCM log, plain or (if its name ends in .gz) compressed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "msgs/lcm/log/log_event.h"
#include "runtime/core/whole_file.h"

namespace maploop::lcm_log {

// The log gets its name in close(). Until then, and if close() is never called, a former file of
// that name stays. Events are numbered from 0, like those of LCM's own writer.
class LogWriter {
 public:
  // This and the functions below throw std::runtime_error naming the file if it cannot be written.
  explicit LogWriter(const std::filesystem::path& file)
      : file_(file), compressed_(file.extension() == ".gz") {}

  void write(const LogEvent& event);
  void close();

  std::uint64_t events() const { return events_; }
  std::uint64_t bytes() const { return bytes_; }  // before compression

 private:
  void flush();

  runtime::WholeFile file_;
  bool compressed_;
  std::string pending_;  // whole events
  std::uint64_t events_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace maploop::lcm_log
