// This file saves values to memory and loads them again, with one description for both directions.
//
//   struct Track {
//     std::int64_t id;
//     Eigen::Vector3d point;
//     void archive(auto& ar) { ar(id, point); }
//   };
//   ArchiveWriter writer;  writer(track);            ArchiveReader reader(writer.content());
//   write(seal(writer.content()));                   reader(track);  reader.finish();
//
// A type is described by such a member, or by a function archive(ar, value) beside it. Anything
// that visits all members may be the `ar`: tests fill and compare structs so. Numbers,
// enumerations, times, std containers and Eigen's fixed-size matrices are described here.
// `Archive::loading` distinguishes the directions where they must differ.
//
// A loaded value has the bits of the saved one, on machines of the same byte order. Lengths are not
// trusted: a sequence grows with the elements that the content really contains, so loading needs at
// most a few times the memory of the content. Not thread-safe.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "msgs/named_enum.h"

namespace maploop {

using Bytes = std::vector<std::uint8_t>;

// Reports an error in the content of an archive.
class ArchiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Allocates only if the content outgrows the capacity of the buffer.
class ArchiveWriter {
 public:
  static constexpr bool loading = false;

  // Replaces the contents of the buffer.
  explicit ArchiveWriter(Bytes buffer = {}) : content_(std::move(buffer)) { content_.clear(); }

  template <class... T>
  void operator()(const T&... values);
  void bytes(const void* data, std::size_t size) {
    const auto* begin = static_cast<const std::uint8_t*>(data);
    content_.insert(content_.end(), begin, begin + size);
  }

  // Starts a section with its name and the version of its description.
  void section(std::string_view name, std::uint32_t version);

  const Bytes& content() const { return content_; }
  Bytes take() { return std::exchange(content_, {}); }

 private:
  Bytes content_;
};

// Every member throws ArchiveError that states what is wrong, and where.
class ArchiveReader {
 public:
  static constexpr bool loading = true;

  explicit ArchiveReader(std::span<const std::uint8_t> content)
      : content_(content), left_(content) {}

  template <class... T>
  void operator()(T&... values);
  void bytes(void* data, std::size_t size);

  // Throws if another section, or another version of it, follows.
  void section(std::string_view name, std::uint32_t version);

  // Reads the length of a sequence; throws if it exceeds the number of bytes left.
  std::size_t length();
  std::size_t bytes_left() const { return left_.size(); }
  // Throws if bytes are left over.
  void finish() const;
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::span<const std::uint8_t> content_;
  std::span<const std::uint8_t> left_;
  std::string section_;
};

// Returns the content with a header that contains a signature, its length and its checksum (XXH3).
Bytes seal(std::span<const std::uint8_t> content);
// Returns the content. Throws ArchiveError: not an archive, of another version, cut, too long or
// damaged.
std::span<const std::uint8_t> unseal(std::span<const std::uint8_t> sealed);

// Reads the sealed content of a file of at most `limit` bytes. Its header is checked before the
// rest is read. Throws ArchiveError, or FileError if the file cannot be read.
Bytes read_sealed(const std::filesystem::path& file, std::size_t limit);

// Returns what write(ArchiveWriter&) writes, sealed.
template <class Write>
Bytes sealed_archive(const Write& write) {
  ArchiveWriter writer;
  write(writer);
  return seal(writer.content());
}

// Reads such a file by read(ArchiveReader&), which must take all of it. Throws as read_sealed()
// and unseal() do.
template <class Read>
void read_archive(const std::filesystem::path& file, std::size_t limit, const Read& read) {
  const Bytes sealed = read_sealed(file, limit);
  ArchiveReader reader(unseal(sealed));
  read(reader);
  reader.finish();
}

// Returns a number as a message shows it, with as many digits as it needs.
template <class T>
requires std::is_arithmetic_v<T> std::string shown(T value) {
  if constexpr (std::is_same_v<T, bool>) {
    return value ? "true" : "false";
  } else {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
  }
}

// Archives a value that must be the same on both sides, such as a calibration: loading throws if it
// differs.
template <class T>
void archive_same(ArchiveWriter& ar, std::string_view, const T& value) {
  ar(value);
}
template <class T>
void archive_same(ArchiveReader& ar, std::string_view what, const T& value) {
  ArchiveWriter own;
  own(value);
  Bytes saved(own.content().size());
  ar.bytes(saved.data(), saved.size());
  if (saved != own.content()) ar.fail("it was saved with another " + std::string(what));
}

// Does the same for a number; the error contains both values.
template <class Archive, class T>
requires std::is_arithmetic_v<T>
void archive_same_number(Archive& ar, std::string_view name, const T& own) {
  T saved = own;
  ar(saved);
  if constexpr (Archive::loading) {
    if (saved != own) {
      ar.fail("it was saved with " + std::string(name) + " = " + shown(saved) +
              ", and here it is " + shown(own));
    }
  }
}

// --- These functions describe types that are not ours.

template <class Archive, class T>
requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void archive(Archive& ar, T& value) {
  ar.bytes(&value, sizeof value);
}

template <class Archive>
void archive(Archive& ar, bool& value) {
  std::uint8_t byte = value ? 1 : 0;
  ar.bytes(&byte, 1);
  value = byte != 0;
}

template <class Archive, class Rep, class Period>
void archive(Archive& ar, std::chrono::duration<Rep, Period>& value) {
  Rep count = value.count();
  ar(count);
  value = std::chrono::duration<Rep, Period>(count);
}

template <class Archive, class Clock, class Duration>
void archive(Archive& ar, std::chrono::time_point<Clock, Duration>& value) {
  Duration since = value.time_since_epoch();
  ar(since);
  value = std::chrono::time_point<Clock, Duration>(since);
}

template <class Archive, class Scalar, int rows, int columns>
requires(rows > 0 && columns > 0) void archive(Archive& ar,
                                               Eigen::Matrix<Scalar, rows, columns>& value) {
  ar.bytes(value.data(), sizeof(Scalar) * rows * columns);
}

template <class Archive>
void archive(Archive& ar, Eigen::Quaterniond& value) {
  ar(value.coeffs());
}

template <class Archive>
void archive(Archive& ar, Eigen::Isometry3d& value) {
  ar(value.matrix());
}

template <class Archive, class T, std::size_t n>
void archive(Archive& ar, std::array<T, n>& values) {
  for (T& value : values) ar(value);
}

template <class Archive, class Sequence>
requires(std::same_as<Sequence, std::string> ||
         std::same_as<Sequence,
                      std::vector<typename Sequence::value_type>>) void archive(Archive& ar,
                                                                                Sequence& values) {
  using Value = typename Sequence::value_type;
  constexpr bool as_bytes = std::is_arithmetic_v<Value>;
  std::size_t length = values.size();
  if constexpr (Archive::loading) {
    length = ar.length();
    const std::size_t at_once = ar.bytes_left() / sizeof(Value);
    if (as_bytes && length > at_once) ar.fail("a length that the archive cannot hold");
    if constexpr (as_bytes) {
      values.resize(length);
    } else {
      values.reserve(std::min(length, at_once));
    }
  } else {
    ar(std::uint64_t{length});
  }
  if constexpr (as_bytes) {
    ar.bytes(values.data(), length * sizeof(Value));
  } else {
    for (std::size_t i = 0; i < length; ++i) {
      if (i == values.size()) values.emplace_back();
      ar(values[i]);
    }
    values.resize(length);
  }
}

template <class Archive, class T>
void archive(Archive& ar, std::optional<T>& value) {
  bool there = value.has_value();
  ar(there);
  if constexpr (Archive::loading) {
    if (there) {
      value.emplace();
    } else {
      value.reset();
    }
  }
  if (there) ar(*value);
}

template <class Archive, class... T>
void archive(Archive& ar, std::variant<T...>& value) {
  auto index = static_cast<std::uint32_t>(value.index());
  ar(index);
  if constexpr (Archive::loading) {
    std::uint32_t i = 0;
    if (!((index == i++ ? (value.template emplace<T>(), true) : false) || ...)) {
      ar.fail("a value of unknown kind");
    }
  }
  std::visit([&](auto& held) { ar(held); }, value);
}

namespace archive_detail {

template <class Archive, class T>
void describe(Archive& ar, T& value) {
  if constexpr (requires { value.archive(ar); }) {
    value.archive(ar);
  } else {
    archive(ar, value);
  }
}

}  // namespace archive_detail

template <class... T>
void ArchiveWriter::operator()(const T&... values) {
  // One description serves both directions; writing does not change the value.
  (archive_detail::describe(*this, const_cast<T&>(values)), ...);
}

template <class... T>
void ArchiveReader::operator()(T&... values) {
  (archive_detail::describe(*this, values), ...);
}

}  // namespace maploop
