// In which form a recorder's events are written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "runtime/vehicle/output/recorded_file.h"

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
  virtual std::size_t flush() = 0;   // all that was given is in the file, or counted
  virtual std::size_t finish() = 0;  // the last call
};

// Makes the format of a file, which outlives it.
using LogFormatOf = std::function<std::unique_ptr<LogFormat>(RecordedFile&)>;

// A standard LCM log, which every LCM tool can read.
std::unique_ptr<LogFormat> lcm_log_format(RecordedFile& file);

}  // namespace maploop::vehicle
