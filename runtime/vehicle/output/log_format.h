// In which form a recorder's events are written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace maploop::vehicle {

// A LogBatch contains whole events of an LCM log in memory that are to be written to the disk.
struct LogBatch {
  std::vector<std::uint8_t> bytes;
  std::vector<std::size_t> ends;  // end of each event in `bytes`
};

// Each function returns how many events, of those given so far, turned out not to be in the file.
// The recorder's thread calls them.
class LogFormat {
 public:
  LogFormat() = default;
  virtual ~LogFormat() = default;
  LogFormat(const LogFormat&) = delete;
  LogFormat& operator=(const LogFormat&) = delete;

  virtual std::size_t write(const LogBatch& batch) = 0;
  virtual std::size_t flush() = 0;   // all that was given is on the disk, or counted
  virtual std::size_t finish() = 0;  // the same; the last call
};

// Opens the file of that name. Throws std::runtime_error naming it if it cannot be written.
using LogFormatOf = std::function<std::unique_ptr<LogFormat>(const std::string& file)>;

// A standard LCM log, which every LCM tool can read.
std::unique_ptr<LogFormat> lcm_log_format(const std::string& file);

}  // namespace maploop::vehicle
