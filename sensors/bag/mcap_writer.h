// This file writes MCAP files: messages in chunks of Zstandard, with an index.
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

struct McapChannel {
  std::string topic;
  std::string encoding;     // of the messages
  std::string schema_name;  // empty: the channel has no schema
  std::string schema_encoding, schema;
};

// The file is made of parts: chunks, and the summary. A part that could not be written is as if its
// messages had never come: the next part follows the one before, and the index does not name it.
class McapWriter {
 public:
  // Appends a part to the file and returns true, or leaves the file as it was and returns false. It
  // may throw, which ends the writing.
  using Append = std::function<bool(std::string_view)>;

  explicit McapWriter(Append append) : append_(std::move(append)) {}

  // Adds a topic, and its schema if no topic has had it; returns its number. Throws
  // std::runtime_error if there are 65535 of them.
  std::uint16_t add_channel(const McapChannel& channel);

  // `nanoseconds` are since 1970 and not negative.
  void write(std::uint16_t channel, std::int64_t nanoseconds, std::string_view data);

  // These return the uncompressed size of the current chunk, and the time between its first and its
  // last message.
  std::size_t chunk_bytes() const { return in_chunk_.empty() ? 0 : chunk_.size(); }
  std::uint64_t chunk_nanoseconds() const { return last_ - first_; }

  // Ends the chunk. Returns whether its messages are in the file.
  bool end_chunk();

  // Ends the file. Returns whether it has its index; without one it is read from front to back.
  bool close();

  std::uint64_t messages() const { return messages_; }  // in chunks that are in the file
  std::size_t channels() const { return counts_.size(); }

 private:
  struct Index {
    std::uint64_t first = 0, last = 0, offset = 0, size = 0;
    std::map<std::uint16_t, std::uint64_t> channels;  // where their message indexes are
    std::uint64_t indexes_size = 0, packed_size = 0, plain_size = 0;
  };

  std::string head() const;  // of the file, if nothing has been written yet
  bool append_part(const std::string& part);
  std::string summary() const;

  Append append_;
  std::uint64_t offset_ = 0;  // end of the file
  std::string chunk_;         // records that are not yet written
  std::string declared_;      // schemas and channels, for the summary
  std::string new_in_chunk_;  // of them
  std::map<std::string, std::uint16_t> schemas_;
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> in_chunk_;
  std::map<std::uint16_t, std::uint64_t> counts_;  // of messages in the file
  std::vector<std::uint32_t> sequences_;           // of messages that came, by channel
  std::vector<Index> chunks_;
  std::uint64_t first_ = 0, last_ = 0;  // of the chunk
  std::uint64_t messages_ = 0;
};

}  // namespace maploop::sensors::bag
