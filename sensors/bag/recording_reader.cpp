#include "sensors/bag/recording_reader.h"

#include <new>
#include <utility>

#include "msgs/input_limits.h"
#include "sensors/bag/compression.h"

namespace maploop::sensors::bag {

const Topic* TopicTable::add(const Topic& topic) {
  const auto [place, is_new] = topics_.try_emplace({topic.name, topic.type, topic.encoding});
  if (!is_new) return &place->second;
  // A topic without any text takes memory, too.
  bytes_ += sizeof topic + 2 * (topic.name.size() + topic.type.size() + topic.encoding.size()) +
            topic.definition.size();
  if (bytes_ > input_limits::table) {
    topics_.erase(place);
    throw Malformed("the topics and their types have more than " +
                    std::to_string(input_limits::table) + " bytes");
  }
  place->second = topic;
  return &place->second;
}

std::string ros1_type(std::string_view type) {
  constexpr std::string_view middle = "/msg/";
  std::string name(type);
  if (const auto at = name.find(middle); at != std::string::npos)
    name.replace(at, middle.size(), "/");
  return name;
}

RecordingReader::RecordingReader(const Opening& opening)
    : file_(opening.file), selection_(opening.selection), topics_(opening.topics) {}

MessageReader::Item RecordingReader::next() {
  for (;;) {
    if (!damages_.empty()) {
      damage_ = std::move(damages_.front());
      damages_.pop_front();
      return Item::damage;
    }
    if (delivered_ < waiting_.size()) {
      const Waiting& w = waiting_[delivered_++];
      message_ = {w.topic, w.received, w.data};
      if (inflate_message()) return Item::message;
    } else if (ended_) {
      return Item::end;
    } else {
      delivered_ = 0;
      waiting_.clear();
      ended_ = !read_more_or_damage();
    }
  }
}

bool RecordingReader::read_more_or_damage() {
  try {
    return read_more();
  } catch (const std::bad_alloc&) {
    waiting_ = {};
    add_damage(offset_, "what is stored there does not fit into memory");
  } catch (const Malformed& error) {
    add_damage(offset_, error.what());
  }
  return true;
}

// rosbag2 may compress each message. A message in CDR never begins as Zstandard's frames do.
bool RecordingReader::inflate_message() {
  if (message_.topic->encoding != "cdr" || !is_zstd(message_.data)) return true;
  std::string error;
  try {
    Inflated result = inflate("zstd", message_.data, {}, inflated_);
    message_.data = result.bytes;
    error = std::move(result.error);
  } catch (const std::bad_alloc&) {
    error = "it does not fit into memory";
  }
  if (!error.empty())
    add_damage(offset_, "a message of " + message_.topic->name + " is left out: " + error);
  return error.empty();
}

void RecordingReader::add_damage(std::uint64_t offset, std::string reason) {
  damages_.push_back({file_, offset, std::move(reason)});
}

bool RecordingReader::selects(const Topic& topic) const {
  return selection_.topics.empty() || selection_.topics.contains(topic.name);
}

}  // namespace maploop::sensors::bag
