#include "ppp/heights/zip_archive.h"

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <stdexcept>

namespace maploop::ppp {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw std::runtime_error("the ZIP archive " + why);
}

// Returns the little-endian number of `size` bytes at `at`.
std::uint32_t number(std::string_view bytes, std::size_t at, std::size_t size) {
  if (at > bytes.size() || size > bytes.size() - at) refuse("is cut: get it once more");
  std::uint32_t value = 0;
  for (std::size_t i = size; i-- > 0;)
    value = value << 8U | static_cast<std::uint8_t>(bytes[at + i]);
  return value;
}

std::string_view part(std::string_view bytes, std::size_t at, std::size_t size) {
  if (at > bytes.size() || size > bytes.size() - at) refuse("is cut: get it once more");
  return bytes.substr(at, size);
}

bool has_ending(std::string_view name, std::string_view ending) {
  if (name.size() < ending.size()) return false;
  const std::string_view end = name.substr(name.size() - ending.size());
  return std::equal(end.begin(), end.end(), ending.begin(), [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == b;
  });
}

// Returns the place of the record that ends an archive: the last of its signatures.
std::size_t end_of_directory(std::string_view archive) {
  const std::size_t at = archive.rfind(std::string_view("PK\x05\x06", 4));
  if (at == std::string_view::npos) refuse("has no directory: it is cut, or no such archive");
  return at;
}

// A file of the archive, according to its directory.
struct Member {
  std::uint32_t flags = 0, method = 0, checksum = 0, packed = 0, size = 0, at = 0;
};

Member find(std::string_view archive, std::string_view ending) {
  constexpr std::string_view signature("PK\x01\x02", 4);
  constexpr std::size_t fixed = 46;  // bytes of an entry before its name
  const std::size_t end = end_of_directory(archive);
  std::size_t at = number(archive, end + 16, 4);
  for (std::uint32_t left = number(archive, end + 10, 2); left > 0; --left) {
    if (part(archive, at, 4) != signature) refuse("has a damaged directory: get it once more");
    const std::size_t name = number(archive, at + 28, 2);
    if (has_ending(part(archive, at + fixed, name), ending)) {
      return {number(archive, at + 8, 2),  number(archive, at + 10, 2),
              number(archive, at + 16, 4), number(archive, at + 20, 4),
              number(archive, at + 24, 4), number(archive, at + 42, 4)};
    }
    at += fixed + name + number(archive, at + 30, 2) + number(archive, at + 32, 2);
  }
  refuse("contains no file *" + std::string(ending));
}

// Inflates exactly `size` bytes.
std::string inflated(std::string_view packed, std::size_t size) {
  std::string text(size, '\0');
  z_stream stream{};
  constexpr int raw = -15;  // the largest window, without zlib's header
  if (inflateInit2(&stream, raw) != Z_OK) throw std::bad_alloc();
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  const int result = inflate(&stream, Z_FINISH);
  const bool whole = result == Z_STREAM_END && stream.total_out == size;
  inflateEnd(&stream);
  if (!whole) refuse("is damaged: get it once more");
  return text;
}

}  // namespace

std::string unpacked(std::string_view archive, std::string_view ending, std::size_t limit) {
  const Member m = find(archive, ending);
  if ((m.flags & 1U) != 0) refuse("is encrypted: unpack it first");
  if (m.size > limit) {
    refuse("contains " + std::to_string(m.size) + " bytes, at most " + std::to_string(limit) +
           " are expected");
  }
  constexpr std::size_t fixed = 30;  // bytes before the name that stands before the content
  if (part(archive, m.at, 4) != std::string_view("PK\x03\x04", 4)) {
    refuse("has a damaged directory: get it once more");
  }
  const std::size_t begin =
      m.at + fixed + number(archive, m.at + 26, 2) + number(archive, m.at + 28, 2);
  const std::string_view packed = part(archive, begin, m.packed);
  constexpr std::uint32_t stored = 0, deflated = 8;
  std::string text;
  if (m.method == stored && m.packed == m.size) {
    text = packed;
  } else if (m.method == deflated) {
    text = inflated(packed, m.size);
  } else {
    refuse("is packed by method " + std::to_string(m.method) + ": unpack it first");
  }
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size()));
  if (sum != m.checksum) refuse("is damaged: the checksum differs; get it once more");
  return text;
}

}  // namespace maploop::ppp
