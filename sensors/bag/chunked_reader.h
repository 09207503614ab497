// This file contains what MCAP files and ROS 1 bags have in common: both are rows of records, many
// of which are chunks: compressed rows of messages. An index may follow.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "sensors/bag/compression.h"
#include "sensors/bag/file_bytes.h"
#include "sensors/bag/recording_reader.h"

namespace maploop::sensors::bag {

struct Record {
  std::uint8_t op = 0;
  Bytes fields;            // of its header
  Bytes data;              // as far as the file or chunk contains it
  std::uint64_t size = 0;  // of all of it; if the bytes are too few to know: how many that takes
};

struct Chunk {
  std::string_view compression;
  InflatedSize size;
  std::uint32_t crc = 0;  // of the inflated bytes; 0: not known
  Bytes data;
  bool cut = false;  // the file ends in it
};

class ChunkedReader : public RecordingReader {
 public:
  std::optional<std::vector<TopicSummary>> index_summary() final;

 protected:
  enum class Use { none, skip, alone, inside_too, chunk, end };

  // An entry of the index.
  struct ChunkPlace {
    std::uint64_t offset = 0;
    Time first{}, last{};                 // of its messages
    std::vector<std::uint32_t> channels;  // that have messages in it; empty: not known
  };

  explicit ChunkedReader(const Opening& opening);

  // Divides off the record that these bytes begin with. Does not throw.
  virtual Record split(Bytes bytes) const = 0;
  // States what to do with a record. There is none of op 0: the bytes are too few, or not a record.
  virtual Use use_of(std::uint8_t op) const = 0;
  virtual Chunk chunk_of(const Record& record) const = 0;
  // Reads a record that is neither skipped nor a chunk. Throws Malformed.
  virtual void take(const Record& record) = 0;

  bool read_more() final;

  // Takes the records of an index from begin to end. Throws Malformed.
  void read_index(std::uint64_t begin, std::uint64_t end);
  // Reads only those chunks of the index from now on that contain something selected.
  void follow_index();
  // Reads all records from there on.
  void read_from(std::uint64_t offset) { position_ = offset; }
  // Its data are incomplete if the file ends before, or if the record is too large or skipped.
  Record record_at(std::uint64_t offset);

  void add_channel(std::uint32_t channel, const Topic& topic);
  bool knows(std::uint32_t channel) const { return channels_.contains(channel); }
  void add_chunk(ChunkPlace place);
  void add_message(std::uint32_t channel, std::uint64_t nanoseconds, Bytes data);

  FileBytes bytes_;
  bool lacks_end_ = false;                         // and should have a mark there
  std::vector<ChunkPlace> chunks_;                 // of the index
  std::map<std::uint32_t, std::uint64_t> counts_;  // of messages, by channel; from the index

 private:
  struct Channel {
    const Topic* topic = nullptr;
    bool selected = false;
  };

  void read_next_record();
  void read_chunk(const Record& record);
  void take_messages(const Chunk& chunk, Bytes content);
  bool may_contain(const ChunkPlace& place) const;

  std::unordered_map<std::uint32_t, Channel> channels_;
  bool indexed_ = false;
  std::size_t next_chunk_ = 0;
  std::uint64_t position_ = 0;
  std::vector<std::uint8_t> inflated_;
};

}  // namespace maploop::sensors::bag
