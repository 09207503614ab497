// This file reads bags of ROS 1, version 2.0 (https://wiki.ros.org/Bags/Format/2.0).
#pragma once

#include <cstdint>

#include "sensors/bag/chunked_reader.h"

namespace maploop::sensors::bag {

// Follows the index at the end; a bag that was not closed, or is cut, is read from front to back.
class Ros1BagReader final : public ChunkedReader {
 public:
  // Throws FileError.
  explicit Ros1BagReader(const Opening& opening);

 private:
  Record split(Bytes bytes) const override;
  Use use_of(std::uint8_t op) const override;
  Chunk chunk_of(const Record& record) const override;
  void take(const Record& record) override;

  // `head` is the record of the bag itself. Throws Malformed.
  void read_bag_index(const Record& head);
  void take_connection(const Record& record);
  void take_chunk_info(const Record& record);
};

}  // namespace maploop::sensors::bag
