// This file reads the messages of a recording that a robot's middleware made: ROS 1 bags, rosbag2
// (sqlite3 or MCAP) and MCAP files.
//
//   const auto reader = open_messages(path, {});
//   for (auto item = reader->next(); item != MessageReader::Item::end; item = reader->next()) {
//     if (item == MessageReader::Item::message) use(reader->message());
//     else complain(reader->damage());
//   }
//
// Messages come in the order of the file, which is that of `received` but for recordings that were
// cut or joined. A reader holds one chunk of the file in memory. What is damaged is reported by its
// offset, and what follows it is read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "msgs/time.h"

namespace maploop::sensors {

// Describes the messages of one topic.
struct Topic {
  std::string name;        // such as "/stereo/left/image_raw"
  std::string type;        // as ROS 1 writes it, for ROS 2 too: "sensor_msgs/Image"
  std::string encoding;    // of the messages: "ros1", "cdr", or another one, such as "json"
  std::string definition;  // text of the type and of those that it uses; empty where none is stored
};

struct RecordedMessage {
  const Topic* topic = nullptr;        // valid as long as the reader
  Time received{};                     // by the recorder, UTC
  std::span<const std::uint8_t> data;  // valid until the next call of next()
};

struct BagDamage {
  std::filesystem::path file;
  std::uint64_t offset = 0;  // in bytes from the start of the file
  std::string reason;
};

// Chooses what a reader delivers. What is not selected is not decompressed where the file's index
// allows it.
struct MessageSelection {
  std::set<std::string> topics;  // empty: all
  Time begin = Time::min();      // messages that were received earlier are left out
};

class MessageReader {
 public:
  enum class Item { message, damage, end };

  MessageReader() = default;
  virtual ~MessageReader() = default;
  MessageReader(const MessageReader&) = delete;
  MessageReader& operator=(const MessageReader&) = delete;

  // Does not throw because of the file's content.
  virtual Item next() = 0;

  // These belong to the last next() that returned message or damage.
  const RecordedMessage& message() const { return message_; }
  const BagDamage& damage() const { return damage_; }

 protected:
  RecordedMessage message_;
  BagDamage damage_;
};

// Returns whether the path is a file that begins as one of these formats does, or a folder with
// metadata.yaml of rosbag2 or with such files.
bool is_bag(const std::filesystem::path& path);

// Opens a file, or all files of a folder one after the other. Throws std::runtime_error that names
// the file and states what to do: not readable, of another format or version, nothing in it.
std::unique_ptr<MessageReader> open_messages(const std::filesystem::path& path,
                                             const MessageSelection& selection);

// Describes what a recording contains of one topic.
struct TopicSummary {
  Topic topic;
  std::uint64_t messages = 0;
  Time first{}, last{};  // received
};

struct BagSummary {
  std::vector<TopicSummary> topics;  // in the order of their names
  std::vector<BagDamage> damage;     // the first 100
};

// Reads the index of a recording, or all of it where there is none.
BagSummary summarize(const std::filesystem::path& path);

}  // namespace maploop::sensors
