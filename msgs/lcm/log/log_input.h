// This file reads the bytes of a log, plain or gzip-compressed, through a window that grows only as
// far as requested.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

struct gzFile_s;  // zlib's

namespace maploop::lcm_log {

class LogInput {
 public:
  // Throws std::runtime_error that names the file if it is not a file or cannot be read.
  explicit LogInput(const std::filesystem::path& file);

  // Returns at least `size` bytes from position() on, fewer only if the log ends before. Valid
  // until the next call of a member that is not const.
  std::span<const std::uint8_t> peek(std::size_t size);

  // Precondition: count <= the number of bytes that peek returned.
  void skip(std::size_t count);

  std::uint64_t position() const { return position_; }  // in the uncompressed log

  // States why reading ended before the end of the file (a read error, a damaged or truncated .gz);
  // empty if it did not.
  const std::string& failure() const { return failure_; }

  // These are sizes of the file on disk, in bytes, for a progress line.
  std::uint64_t file_size() const { return file_size_; }
  std::uint64_t file_position() const;

 private:
  void read_more(std::size_t size);
  void note_failure();

  std::unique_ptr<gzFile_s, int (*)(gzFile_s*)> stream_;
  std::vector<std::uint8_t> window_;
  std::size_t begin_ = 0, end_ = 0;  // the part that is filled and not yet skipped
  std::uint64_t position_ = 0;
  std::uint64_t file_size_ = 0;
  bool at_end_ = false;
  std::string failure_;
};

}  // namespace maploop::lcm_log
