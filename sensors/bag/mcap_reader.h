// This file reads MCAP files (https://mcap.dev/spec), version 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "sensors/bag/chunked_reader.h"

namespace maploop::sensors::bag {

// Follows the chunk index of the summary section; a file without one is read from front to back.
class McapReader final : public ChunkedReader {
 public:
  // Throws FileError.
  explicit McapReader(const Opening& opening);

 private:
  struct Schema {
    std::string name, text;
  };

  Record split(Bytes bytes) const override;
  Use use_of(std::uint8_t op) const override;
  Chunk chunk_of(const Record& record) const override;
  void take(const Record& record) override;

  // Returns whether the file has an index of all its chunks. Throws Malformed.
  bool read_summary();
  bool has_crc(std::uint64_t begin, std::uint64_t end, std::uint32_t crc);
  void take_schema(ByteCursor fields);
  void take_channel(ByteCursor fields);
  void take_message(ByteCursor fields);
  void take_chunk_index(ByteCursor fields);
  void take_statistics(ByteCursor fields);

  std::map<std::uint16_t, Schema> schemas_;
  std::size_t schema_bytes_ = 0;
  std::uint32_t stated_chunks_ = 0;
};

}  // namespace maploop::sensors::bag
