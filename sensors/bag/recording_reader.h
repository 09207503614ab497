// This file contains what the readers of all containers have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "sensors/bag/byte_cursor.h"
#include "sensors/bag/message_reader.h"

namespace maploop::sensors::bag {

// A TopicTable owns the topics of a recording, which may have several files. Pointers to them stay
// valid as long as the table.
class TopicTable {
 public:
  // Returns the topic of that name, type and encoding. Throws Malformed if all topics together have
  // more than input_limits::table bytes.
  const Topic* add(const Topic& topic);

 private:
  std::map<std::tuple<std::string, std::string, std::string>, Topic> topics_;
  std::size_t bytes_ = 0;
};

// Returns the name as ROS 1 writes it: "sensor_msgs/Image" for "sensor_msgs/msg/Image".
std::string ros1_type(std::string_view type);

// Holds what the reader of one file needs to open it.
struct Opening {
  std::filesystem::path file;  // as messages name it
  std::filesystem::path path;  // what is opened: the same, or that file decompressed
  std::shared_ptr<TopicTable> topics;
  MessageSelection selection;
};

class RecordingReader : public MessageReader {
 public:
  Item next() final;

  // Whether next() returns damage without reading on.
  bool has_damage() const { return !damages_.empty(); }

  // Returns what the index says, in any order; nothing if the file has none.
  virtual std::optional<std::vector<TopicSummary>> index_summary() = 0;

 protected:
  struct Waiting {
    Time received;
    const Topic* topic;
    Bytes data;
  };

  explicit RecordingReader(const Opening& opening);

  // Adds damage, or messages, or nothing. Returns false at the end. Everything that was added
  // before has been delivered. It may throw Malformed, which becomes damage at offset_.
  virtual bool read_more() = 0;

  void add_damage(std::uint64_t offset, std::string reason);
  bool selects(const Topic& topic) const;
  const Topic* add_topic(const Topic& topic) { return topics_->add(topic); }

  const std::filesystem::path file_;
  const MessageSelection selection_;
  std::uint64_t offset_ = 0;      // of what is being read
  std::vector<Waiting> waiting_;  // messages, in order; cleared before read_more

 private:
  bool read_more_or_damage();
  bool inflate_message();

  std::shared_ptr<TopicTable> topics_;
  std::deque<BagDamage> damages_;
  std::size_t delivered_ = 0;  // of waiting_
  bool ended_ = false;
  std::vector<std::uint8_t> inflated_;
};

}  // namespace maploop::sensors::bag
