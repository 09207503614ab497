// This file writes bags of ROS 1, version 2.0: messages in chunks, with an index.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace maploop::sensors::bag {

struct Ros1Connection {
  std::string topic, type;
  std::string md5;         // of the definition, as ROS computes it
  std::string definition;  // of the type and of those that it uses
};

class Ros1BagWriter {
 public:
  // Appends a part to the file. It may throw, which ends the writing.
  using Append = std::function<void(std::string_view)>;

  // `compression` is "none", "lz4" or "bz2".
  Ros1BagWriter(Append append, std::string compression);

  // Adds a topic; returns its number.
  std::uint32_t add_connection(const Ros1Connection& connection);

  // `nanoseconds` are since 1970, up to the year 2106.
  void write(std::uint32_t connection, std::int64_t nanoseconds, std::string_view data);

  // These return the uncompressed size of the current chunk, and the time between its first and its
  // last message.
  std::size_t chunk_bytes() const { return in_chunk_.empty() ? 0 : chunk_.size(); }
  std::uint64_t chunk_nanoseconds() const { return last_ - first_; }
  void end_chunk();

  // Ends the file. Returns the bytes that are then to replace those at its beginning.
  std::string close();

 private:
  struct ChunkInfo {
    std::uint64_t first = 0, last = 0, offset = 0;
    std::map<std::uint32_t, std::uint32_t> counts;  // of messages, by connection
  };

  std::string head(std::uint64_t index) const;
  void append(const std::string& part);

  Append append_;
  std::string compression_;
  std::uint64_t offset_ = 0;  // end of the file
  std::string chunk_;         // records that are not yet written
  std::string connections_;   // their records, for the index
  std::uint32_t connection_count_ = 0;
  std::map<std::uint32_t, std::vector<std::pair<std::uint64_t, std::uint32_t>>> in_chunk_;
  std::vector<ChunkInfo> chunks_;
  std::uint64_t first_ = 0, last_ = 0;  // of the chunk
};

}  // namespace maploop::sensors::bag
