#include "sensors/replay/log_events.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "sensors/bag/bag_files.h"
#include "sensors/bag/message_reader.h"

namespace maploop::sensors {
namespace {

using lcm_log::Damage;
using lcm_log::LogEvent;
using lcm_log::LogReader;

class LcmLog final : public LogEvents {
 public:
  LcmLog(const std::filesystem::path& file, const schema::Schema& schema) : reader_(file, schema) {}

  Item next() override { return reader_.next(); }
  const LogEvent& event() const override { return reader_.event(); }
  const Damage& damage() const override { return reader_.damage(); }
  std::uint64_t position() const override { return reader_.input().position(); }
  std::uint64_t file_size() const override { return reader_.input().file_size(); }
  std::uint64_t file_position() const override { return reader_.input().file_position(); }

 private:
  LogReader reader_;
};

class RecordedEvents final : public LogEvents {
 public:
  RecordedEvents(const std::filesystem::path& file, std::string_view channel) {
    MessageSelection selection;
    selection.as_written = true;
    if (!channel.empty()) selection.topics.insert(std::string(lcm_topics).append(channel));
    reader_ = open_messages(file, selection);
  }

  Item next() override {
    for (;;) {
      const auto item = reader_->next();
      if (item == MessageReader::Item::end) return Item::end;
      if (item == MessageReader::Item::damage) {
        damage_ = {reader_->damage().offset, reader_->damage().offset, reader_->damage().reason};
        return Item::damage;
      }
      if (take(reader_->message())) return Item::event;
    }
  }
  const LogEvent& event() const override { return event_; }
  const Damage& damage() const override { return damage_; }
  std::uint64_t position() const override { return position_; }
  std::uint64_t file_size() const override { return 0; }
  std::uint64_t file_position() const override { return position_; }

 private:
  bool take(const RecordedMessage& message) {
    const std::string_view topic = message.topic->name;
    std::span<const std::uint8_t> data = message.data;
    const bool in_ros = message.topic->type == lcm_ros_type;
    constexpr std::size_t length_bytes = 4;
    if (in_ros) data = data.subspan(std::min(length_bytes, data.size()));
    if ((message.topic->encoding != lcm_encoding && !in_ros) || !topic.starts_with(lcm_topics))
      return false;
    constexpr std::int64_t nanoseconds = 1000;
    event_ = {.number = events_++,
              .time_us = to_nanoseconds(message.received) / nanoseconds,
              .channel = topic.substr(lcm_topics.size()),
              .data = data,
              .offset = position_};
    position_ += data.size();
    return true;
  }

  std::unique_ptr<MessageReader> reader_;
  LogEvent event_;
  Damage damage_;
  std::int64_t events_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace

bool is_own_recording(const std::filesystem::path& file) {
  return bag::is_own_recording(file);
}

std::unique_ptr<LogEvents> open_log(const std::filesystem::path& file, const schema::Schema& schema,
                                    std::string_view channel) {
  if (is_own_recording(file)) return std::make_unique<RecordedEvents>(file, channel);
  return std::make_unique<LcmLog>(file, schema);
}

}  // namespace maploop::sensors
