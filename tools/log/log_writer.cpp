#include "tools/log/log_writer.h"

#include <array>
#include <utility>

#include "msgs/input_file.h"
#include "msgs/lcm/log/log_header.h"

namespace maploop::lcm_log {

void LogWriter::write(const LogEvent& event) {
  std::array<std::uint8_t, header_bytes> header{};
  const LogHeader values{.sync = sync_word,
                         .number = static_cast<std::int64_t>(events_++),
                         .time_us = event.time_us,
                         .channel_bytes = static_cast<std::int32_t>(event.channel.size()),
                         .data_bytes = static_cast<std::int32_t>(event.data.size())};
  write_header(values, header);
  bytes_ += values.event_bytes();
  pending_.append(header.begin(), header.end());
  pending_ += event.channel;
  pending_.append(event.data.begin(), event.data.end());
  constexpr std::size_t at_once = std::size_t{1} << 20U;
  if (pending_.size() >= at_once) flush();
}

// A file of several gzip members is one gzip file (RFC 1952, section 2.2).
void LogWriter::flush() {
  file_.write(compressed_ ? gzip(pending_) : pending_);
  pending_.clear();
}

void LogWriter::close() {
  flush();
  file_.keep();
}

}  // namespace maploop::lcm_log
