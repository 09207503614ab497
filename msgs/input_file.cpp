#include "msgs/input_file.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <system_error>

namespace maploop {
namespace {

[[noreturn]] void refuse_size(const std::filesystem::path& file, const std::string& size,
                              std::size_t limit) {
  throw FileError(
      file, "too large: " + size + ", at most " + std::to_string(limit) + " bytes are expected");
}

// Returns the size in bytes; throws if the file is not a regular one.
std::uintmax_t require_regular(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found)
    throw FileError(file, "the file is missing");
  if (std::filesystem::is_directory(status))
    throw FileError(file, "is a folder, not a regular file");
  if (!std::filesystem::is_regular_file(status)) throw FileError(file, "not a regular file");
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) throw FileError(file, "cannot be read: " + error.message());
  return size;
}

// Reads the content of a file, whether it is compressed or not.
class Inflater {
 public:
  explicit Inflater(const std::filesystem::path& name)
      : name_(name), stream_(gzopen(name.c_str(), "rb"), gzclose) {
    if (!stream_) throw FileError(name, std::string("cannot be opened: ") + std::strerror(errno));
  }

  // Returns how many bytes were read; fewer than `room` only at the end.
  std::size_t read(char* to, std::size_t room) {
    std::size_t got = 0;
    while (got < room) {
      const auto part = static_cast<unsigned>(std::min<std::size_t>(room - got, 1U << 30U));
      const int count = gzread(stream_.get(), to + got, part);
      if (count < 0) refuse();
      if (count == 0) break;
      got += static_cast<std::size_t>(count);
    }
    int state = Z_OK;
    gzerror(stream_.get(), &state);
    if (state != Z_OK) refuse();  // a cut file ends with Z_BUF_ERROR
    return got;
  }

 private:
  [[noreturn]] void refuse() const {
    throw FileError(name_, "its compressed data are damaged or cut: get it once more");
  }

  std::filesystem::path name_;
  std::unique_ptr<gzFile_s, int (*)(gzFile)> stream_;
};

// Turns a failed allocation of the standard library into a FileError.
template <class Read>
void within_memory(const std::filesystem::path& file, Read read) {
  try {
    read();
  } catch (const std::bad_alloc&) {
    throw FileError(file, "does not fit into memory");
  }
}

template <class Byte>
void read_as_it_is(const std::filesystem::path& file, std::size_t limit, std::vector<Byte>& bytes) {
  const std::uintmax_t size = require_regular(file);
  if (size > limit) refuse_size(file, std::to_string(size) + " bytes", limit);
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw FileError(file, "cannot be opened: no permission to read it?");
  within_memory(file, [&] { bytes.resize(static_cast<std::size_t>(size)); });
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(stream.gcount()) != size)
    throw FileError(file, "cannot be read to its end");
}

}  // namespace

void read_bytes(const std::filesystem::path& file, std::size_t limit, std::vector<char>& bytes) {
  read_as_it_is(file, limit, bytes);
}

void read_bytes(const std::filesystem::path& file, std::size_t limit,
                std::vector<std::uint8_t>& bytes) {
  read_as_it_is(file, limit, bytes);
}

std::string read_text(const std::filesystem::path& file, std::size_t limit) {
  const std::uintmax_t size = require_regular(file);
  if (size > limit) refuse_size(file, std::to_string(size) + " bytes", limit);
  Inflater inflater(file);
  std::string text;
  within_memory(file, [&] {
    // One byte more than the file's size shows that it is not compressed, and has ended.
    std::size_t room = static_cast<std::size_t>(size) + 1;
    for (;;) {
      const std::size_t had = text.size();
      text.resize(had + room);
      const std::size_t got = inflater.read(text.data() + had, room);
      text.resize(had + got);
      if (text.size() > limit) refuse_size(file, "more than that when decompressed", limit);
      if (got < room) return;
      room = std::min(text.size(), limit + 1 - text.size());
    }
  });
  return text;
}

std::string read_head(const std::filesystem::path& file, std::size_t count) {
  require_regular(file);
  std::string text(count, '\0');
  text.resize(Inflater(file).read(text.data(), count));
  return text;
}

std::string gzip(const std::string& text) {
  constexpr int window = 15 + 16;  // the largest, with a gzip header
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY) !=
      Z_OK) {
    throw std::bad_alloc();
  }
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

}  // namespace maploop
