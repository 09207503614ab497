// This file reads whole files; every reader that reads a file at once opens it here. (Streams, such
// as logs and captures, have bounded buffers of their own.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace maploop {

// The text is "FILE: reason".
class FileError : public std::runtime_error {
 public:
  FileError(const std::filesystem::path& file, const std::string& reason)
      : std::runtime_error(file.string() + ": " + reason), reason_(reason) {}
  const std::string& reason() const { return reason_; }  // for callers who name the file

 private:
  std::string reason_;
};

// Each function throws FileError: missing, a folder, not a regular file (reading a pipe, for
// example, could block for ever), larger than `limit` bytes, not readable to its end, or too large
// for the memory.

// Reads the content unchanged into `bytes`, whose capacity is reused.
void read_bytes(const std::filesystem::path& file, std::size_t limit, std::vector<char>& bytes);
void read_bytes(const std::filesystem::path& file, std::size_t limit,
                std::vector<std::uint8_t>& bytes);

// Reads the content, decompressed if it is gzip (detected by content, not by name).
std::string read_text(const std::filesystem::path& file, std::size_t limit);

// Reads the first `count` bytes of that, or fewer if it is shorter.
std::string read_head(const std::filesystem::path& file, std::size_t count);

// Returns the text compressed, with zlib's default level. The results of several texts, one after
// the other, are the compressed form of these texts joined (RFC 1952, section 2.2).
std::string gzip(const std::string& text);

}  // namespace maploop
