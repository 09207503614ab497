#include "tools/log/log_writer.h"

#include <array>
#include <utility>

#include "msgs/input_file.h"
#include "msgs/lcm/log/log_header.h"

namespace maploop::lcm_log {

bool is_mcap_name(const std::filesystem::path& file) {
  return file.extension() == ".mcap";
}

bool is_bag_name(const std::filesystem::path& file) {
  return file.extension() == ".bag";
}

LogWriter::LogWriter(const std::filesystem::path& file, const schema::Schema& schema,
                     const std::string& bag_compression)
    : file_(file), compressed_(file.extension() == ".gz") {
  const auto append = [this](std::string_view part) {
    file_.write(part);
    return true;
  };
  if (is_mcap_name(file)) mcap_ = std::make_unique<McapLog>(append, schema);
  if (is_bag_name(file)) bag_ = std::make_unique<BagLog>(append, bag_compression, schema);
}

void LogWriter::write(const LogEvent& event) {
  std::array<std::uint8_t, header_bytes> header{};
  const LogHeader values{.sync = sync_word,
                         .number = static_cast<std::int64_t>(events_++),
                         .time_us = event.time_us,
                         .channel_bytes = static_cast<std::int32_t>(event.channel.size()),
                         .data_bytes = static_cast<std::int32_t>(event.data.size())};
  bytes_ += values.event_bytes();
  if (mcap_) return mcap_->write(event);
  if (bag_) return bag_->write(event);
  write_header(values, header);
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
  if (mcap_) {
    mcap_->close();
  } else if (bag_) {
    file_.replace_head(bag_->close());
  } else {
    flush();
  }
  file_.keep();
}

}  // namespace maploop::lcm_log
