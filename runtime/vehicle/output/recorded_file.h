// The file that a run records to.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace maploop::vehicle {

// It always ends with a whole part, such as an event: one that does not fit on the disk is removed
// again. One thread at a time.
class RecordedFile {
 public:
  // Replaces the file. Throws std::runtime_error naming it if it cannot be written, or if another
  // recording, of any process, is writing it.
  explicit RecordedFile(const std::string& path);
  ~RecordedFile();
  RecordedFile(const RecordedFile&) = delete;
  RecordedFile& operator=(const RecordedFile&) = delete;

  // Appends parts, which end at `ends` of the bytes. Returns how many were written.
  std::size_t append(std::span<const std::uint8_t> bytes, std::span<const std::size_t> ends);

  void sync();  // to the disk

 private:
  std::size_t put(std::span<const std::uint8_t> bytes);

  int descriptor_;
  off_t size_ = 0;  // bytes of whole parts
};

}  // namespace maploop::vehicle
