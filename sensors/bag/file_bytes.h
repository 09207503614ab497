// This file reads parts of a file through a window that grows only as far as requested.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "sensors/bag/byte_cursor.h"

namespace maploop::sensors::bag {

class FileBytes {
 public:
  // Throws FileError.
  explicit FileBytes(const std::filesystem::path& file);
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  std::uint64_t size() const { return size_; }

  // Returns `count` bytes from `offset` on; fewer only where the file ends or the disk fails. Valid
  // until the next call.
  Bytes at(std::uint64_t offset, std::size_t count);

 private:
  int file_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t begin_ = 0;  // of the window
  std::size_t filled_ = 0;
  std::vector<std::uint8_t> window_;
};

}  // namespace maploop::sensors::bag
