// This file unpacks recordings that were compressed as a whole.
#pragma once

#include <filesystem>
#include <string>

namespace maploop::sensors::bag {

// Returns the first bytes of a file after decompression (.zstd, .gz; detected by content); fewer
// than 64 if the file is shorter. Throws FileError.
std::string unpacked_head(const std::filesystem::path& file);

// An UnpackedFile is a file as it can be read in place. If the file is compressed, this is a
// temporary file that is removed at once, so that it takes space only as long as it is open.
class UnpackedFile {
 public:
  // Throws FileError: not readable, damaged, more than input_limits::unpacked_bag, no space.
  explicit UnpackedFile(const std::filesystem::path& file);
  ~UnpackedFile();
  UnpackedFile(const UnpackedFile&) = delete;
  UnpackedFile& operator=(const UnpackedFile&) = delete;

  // Returns the file that can be opened as long as this object lives.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  bool temporary_ = false;
};

}  // namespace maploop::sensors::bag
