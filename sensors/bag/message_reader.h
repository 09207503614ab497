// This file reads the messages of a recording that a robot's middleware made: ROS 1 bags, rosbag2
// (sqlite3 or MCAP) and MCAP files.
//
//   const auto reader = open_messages(path, {});
//   for (auto item = reader->next(); item != MessageReader::Item::end; item = reader->next()) {
//     if (item == MessageReader::Item::message) use(reader->message());
//     else complain(reader->damage());
//   }
//
// Messages come in the order of `received` within a database, and within each chunk of a bag or
// MCAP file; chunks come in the order of their first message where the file has an index, else in
// that of the file. Chunks may overlap: what was written topic by topic comes so. The files of a
// folder follow each other. A reader holds one chunk of one file in memory; of a file that is
// compressed as a whole (.zstd, .gz), a plain copy is on the disk while it is open.
//
// What is damaged is reported by its offset, and left out; what follows it is read unless its place
// is unknown, as behind a damaged length in a file without index. A file that was cut delivers what
// is before the cut.
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
  std::string definition;  // text of the type and of those that it uses; empty where none is
                           // stored, or where it is not a text (protobuf, flatbuffer)
};

struct RecordedMessage {
  const Topic* topic = nullptr;        // valid as long as the reader
  Time received{};                     // by the recorder, UTC
  std::span<const std::uint8_t> data;  // valid until the next call of next()
};

struct BagDamage {
  std::filesystem::path file;
  // In bytes from the start of the file, or of its decompressed form: of the damaged record or
  // chunk. In a database 0, as SQLite does not say where a row is, or where the database was cut.
  std::uint64_t offset = 0;
  std::string reason;
};

// Chooses what a reader delivers. What is not selected is not decompressed where the file's index
// allows it.
struct MessageSelection {
  std::set<std::string> topics;  // empty: all
  Time begin = Time::min();      // messages that were received earlier are left out
  bool as_written = false;  // bags and MCAP files: in the order of the file, whatever the times
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

// Returns whether the path is a file that begins as one of these formats does, also compressed as a
// whole, or a folder with such a file: named by metadata.yaml of rosbag2, or *.bag, *.db3, *.mcap.
// Any SQLite database begins as one of rosbag2; our own recordings (sensors/replay/log_events.h)
// are none. Does not throw.
bool is_bag(const std::filesystem::path& path);

// Opens a file, or all files of a folder one after the other: those that metadata.yaml of rosbag2
// names, or the recordings in the natural order of their names. Throws std::runtime_error that
// names the first file and states what to do, if no file can be opened: not readable, of another
// format or version, nothing in it. Otherwise such a file is damage.
std::unique_ptr<MessageReader> open_messages(const std::filesystem::path& path,
                                             const MessageSelection& selection);

// Describes what a recording contains of one topic, which has at least one message.
struct TopicSummary {
  Topic topic;
  std::uint64_t messages = 0;
  // Received. From the index of a bag or MCAP file they are the times of the chunks that contain
  // messages of the topic, and therefore up to a chunk (usually less than a second) too early and
  // too late.
  Time first{}, last{};
};

struct BagSummary {
  std::vector<TopicSummary> topics;  // in the order of their names
  std::vector<BagDamage> damage;     // the first 100
};

// Reads the index of a recording, or all of it where there is none. Damage is only what was found
// on the way. Throws as open_messages does.
BagSummary summarize(const std::filesystem::path& path);

}  // namespace maploop::sensors
