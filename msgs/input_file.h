// Reading whole files: the one place where a reader opens what it reads at once. (What is read as a
// stream, logs and captures, has a bounded buffer of its own.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace maploop {

// "FILE: reason".
class FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& file, const std::string& reason)
      : std::runtime_error(file.string() + ": " + reason), reason_(reason) {}
  const std::string& reason() const { return reason_; }  // for a caller who names the file himself

 private:
  std::string reason_;
};

// Each throws FileError: missing, a folder, not a regular file (a pipe, for one, would be waited
// for without end), larger than `limit` bytes, not readable to its end, or too large for the
// memory.

// The content as it is, into `bytes`, whose capacity is reused.
void read_bytes(const std::filesystem::path& file, std::size_t limit, std::vector<char>& bytes);
void read_bytes(const std::filesystem::path& file, std::size_t limit,
                std::vector<std::uint8_t>& bytes);

// The content, decompressed where it is gzip (told by content, not by name).
std::string read_text(const std::filesystem::path& file, std::size_t limit);

// The first `count` bytes of that, or what it has of them.
std::string read_head(const std::filesystem::path& file, std::size_t count);

}  // namespace maploop
