// Writes an LCM log, plain or (if its name ends in .gz) compressed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "msgs/lcm/log/log_event.h"

namespace maploop::lcm_log {

// The log gets its name in close(). Until then, and if close() is never called, a former file of
// that name stays. Events are numbered from 0, like those of LCM's own writer.
class LogWriter {
 public:
  // This and the functions below throw std::runtime_error naming the file if it cannot be written.
  explicit LogWriter(const std::filesystem::path& file);
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  void write(const LogEvent& event);
  void close();

  std::int64_t events() const { return events_; }
  std::uint64_t bytes() const { return bytes_; }  // before compression

 private:
  struct Stream;

  void put(const void* bytes, std::size_t size);
  [[noreturn]] void fail(const char* why);

  std::filesystem::path file_;
  std::filesystem::path part_;  // its name until close()
  std::unique_ptr<Stream> stream_;
  std::int64_t events_ = 0;
  std::uint64_t bytes_ = 0;
};

// Throws std::invalid_argument if `output` is the same file as `input`.
void refuse_same_file(const std::filesystem::path& input, const std::filesystem::path& output);

}  // namespace maploop::lcm_log
