// This file writes a file completely or not at all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

namespace maploop {

// The file is written from beginning to end through a buffer of fixed size, under the name
// FILE.part. Only keep() gives it its own name, when all of it is on the disk: an earlier file
// stays complete until then, even if the disk is full or the power fails. If the file is not a
// regular one (a device, a pipe), it is written directly.
//
// Every function throws std::runtime_error that names the file, the system's reason and what to do.
// One thread at a time.
class WholeFile {
 public:
  explicit WholeFile(const std::filesystem::path& file);
  ~WholeFile();  // without keep(): discards what was written
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(std::string_view bytes);
  void write(std::span<const std::uint8_t> bytes);
  // Replaces the beginning of what was written; not of a pipe.
  void replace_head(std::string_view bytes);
  void replace_head(std::span<const std::uint8_t> bytes);
  void keep();

 private:
  void flush();
  [[noreturn]] void fail(int error) const;

  static constexpr std::size_t chunk_bytes = std::size_t{64} * 1024;

  std::filesystem::path file_;
  std::filesystem::path written_;  // equals file_ if that is not a regular file
  int descriptor_ = -1;
  std::size_t used_ = 0;
  std::unique_ptr<std::array<char, chunk_bytes>> buffer_;
};

// Writes all bytes at once.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes);
void write_whole_file(const std::filesystem::path& file, std::span<const std::uint8_t> bytes);

}  // namespace maploop
