// Writes MCAP files (the format's specification: mcap.dev/spec): messages in JSON, in chunks of
// zstd, with an index.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/core/whole_file.h"

namespace maploop::lcm_log {

// The file gets its name in close(). Until then, and if close() is never called, a former file of
// that name stays. The constructor and the functions below throw std::runtime_error that names the
// file if it cannot be written.
class McapWriter {
 public:
  explicit McapWriter(const std::filesystem::path& file);

  // Adds a topic, and its schema if no topic has had it; returns its number.
  std::uint16_t add_channel(const std::string& topic, const std::string& schema_name,
                            const std::string& json_schema);

  // `nanoseconds` are since 1970 and not negative.
  void write(std::uint16_t channel, std::int64_t nanoseconds, std::string_view json);

  void close();

  std::uint64_t messages() const { return messages_; }

 private:
  struct Index {
    std::uint64_t first = 0, last = 0, offset = 0, size = 0;
    std::map<std::uint16_t, std::uint64_t> channels;  // where their message indexes are
    std::uint64_t indexes_size = 0, packed_size = 0, plain_size = 0;
  };

  void put(std::string_view bytes);
  void flush_chunk();
  std::string summary() const;

  runtime::WholeFile file_;
  std::uint64_t offset_ = 0;
  std::string chunk_;     // records that are not yet written
  std::string declared_;  // schemas and channels, for the summary
  std::map<std::string, std::uint16_t> schemas_;
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> in_chunk_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::vector<Index> chunks_;
  std::uint64_t first_ = 0, last_ = 0;              // of the chunk
  std::uint64_t whole_first_ = 0, whole_last_ = 0;  // of the file
  std::uint64_t messages_ = 0;
};

}  // namespace maploop::lcm_log
