#include "msgs/archive.h"

#include <algorithm>

#include <cstring>

#include "msgs/input_file.h"
#include "msgs/xxh3.h"

namespace maploop {
namespace {

constexpr std::array<char, 8> signature{'m', 'a', 'p', 'l', 'o', 'o', 'p', '\n'};
constexpr std::uint64_t format_version = 1;

struct Header {
  std::array<char, 8> signature;
  std::uint64_t version;
  std::uint64_t size;      // of the content
  std::uint64_t checksum;  // of the content
};

// Checks and returns the header at the start of a file of `size` bytes.
Header judged(std::span<const std::uint8_t> head, std::uintmax_t size) {
  Header header{};
  const std::size_t shown = std::min(head.size(), sizeof header);
  if (shown > 0) std::memcpy(&header, head.data(), shown);
  if (shown < sizeof header.signature || header.signature != signature) {
    throw ArchiveError("it is no archive of maploop");
  }
  if (shown < sizeof header) throw ArchiveError("it is cut: not even its header is whole");
  if (header.version != format_version) {
    throw ArchiveError("its format is version " + std::to_string(header.version) +
                       ", this program reads version " + std::to_string(format_version));
  }
  if (size - sizeof header != header.size) {
    throw ArchiveError("it holds " + std::to_string(size - sizeof header) + " bytes where " +
                       std::to_string(header.size) +
                       " were saved: it is cut, or joined to another");
  }
  return header;
}

}  // namespace

void ArchiveWriter::section(std::string_view name, std::uint32_t version) {
  (*this)(std::uint64_t{name.size()});
  bytes(name.data(), name.size());
  (*this)(version);
}

void ArchiveReader::fail(const std::string& what) const {
  std::string where = "byte " + std::to_string(content_.size() - left_.size());
  if (!section_.empty()) where = "section '" + section_ + "', " + where;
  throw ArchiveError(what + " (" + where + ")");
}

void ArchiveReader::bytes(void* data, std::size_t size) {
  if (size > left_.size()) fail("the archive ends too early");
  if (size == 0) return;
  std::memcpy(data, left_.data(), size);
  left_ = left_.subspan(size);
}

std::size_t ArchiveReader::length() {
  std::uint64_t count = 0;
  (*this)(count);
  if (count > left_.size()) fail("a length that the archive cannot hold");
  return static_cast<std::size_t>(count);
}

void ArchiveReader::section(std::string_view name, std::uint32_t version) {
  std::string found;
  std::uint32_t found_version = 0;
  (*this)(found);
  if (found != name) {
    fail("section '" + std::string(name) + "' expected, but '" + found + "' is there");
  }
  (*this)(found_version);
  section_ = found;
  if (found_version != version) {
    fail("its version is " + std::to_string(found_version) + ", this program reads version " +
         std::to_string(version) + ": save it again with this program");
  }
}

void ArchiveReader::finish() const {
  if (!left_.empty()) fail(std::to_string(left_.size()) + " bytes are left over");
}

Bytes seal(std::span<const std::uint8_t> content) {
  const Header header{signature, format_version, content.size(),
                      XXH3_64bits(content.data(), content.size())};
  Bytes sealed(sizeof header + content.size());
  std::memcpy(sealed.data(), &header, sizeof header);
  if (!content.empty()) std::memcpy(sealed.data() + sizeof header, content.data(), content.size());
  return sealed;
}

std::span<const std::uint8_t> unseal(std::span<const std::uint8_t> sealed) {
  const Header header = judged(sealed, sealed.size());
  const auto content = sealed.subspan(sizeof header);
  if (XXH3_64bits(content.data(), content.size()) != header.checksum) {
    throw ArchiveError("it is damaged: its checksum does not fit");
  }
  return content;
}

Bytes read_sealed(const std::filesystem::path& file, std::size_t limit) {
  const std::string head = read_head(file, sizeof(Header));
  judged(std::span(reinterpret_cast<const std::uint8_t*>(head.data()), head.size()),
         std::filesystem::file_size(file));
  Bytes sealed;
  read_bytes(file, limit, sealed);
  return sealed;
}

}  // namespace maploop
