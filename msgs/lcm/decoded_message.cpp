#include "msgs/lcm/decoded_message.h"

#include <array>
#include <bit>
#include <charconv>

namespace maploop::schema {
namespace {

constexpr std::size_t kMaximumBytes = std::size_t{1} << 31;
constexpr std::size_t kMaximumNodes = 1'000'000;  // 32 MB
constexpr int kMaximumDepth = 64;

template <class Unsigned>
Unsigned big_endian(const std::uint8_t* bytes) {
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    value = static_cast<Unsigned>(static_cast<std::uint64_t>(value) << 8 | bytes[i]);
  }
  return value;
}

std::int64_t integer(Kind kind, const std::uint8_t* bytes) {
  switch (encoded_size(kind)) {
    case 2:
      return static_cast<std::int16_t>(big_endian<std::uint16_t>(bytes));
    case 4:
      return static_cast<std::int32_t>(big_endian<std::uint32_t>(bytes));
    case 8:
      return static_cast<std::int64_t>(big_endian<std::uint64_t>(bytes));
    default:
      return kind == Kind::byte ? std::int64_t{*bytes}
                                : std::int64_t{static_cast<std::int8_t>(*bytes)};
  }
}

template <class Number>
std::string number_text(Number value) {
  std::array<char, 40> text{};
  return {text.begin(), std::to_chars(text.begin(), text.end(), value).ptr};
}

std::string quoted(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<std::uint8_t>(c);
    if (byte < 0x20 || byte == 0x7f) {
      result += "\\x";
      result += kDigits[byte >> 4];
      result += kDigits[byte & 15];
    } else {
      if (c == '"' || c == '\\') result += '\\';
      result += c;
    }
  }
  return result + '"';
}

}  // namespace

std::string to_text(const Value& value) {
  return std::visit(
      [](const auto& v) -> std::string {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, std::string_view>) {
          return quoted(v);
        } else if constexpr (std::is_same_v<T, bool>) {
          return v ? "true" : "false";
        } else {
          return number_text(v);
        }
      },
      value);
}

// Makes one pass over the bytes. Each step returns false after the first error.
class DecodedMessage::Decoding {
 public:
  explicit Decoding(DecodedMessage& message) : m_(message) {}

  bool message(const Type& type) {
    offset_ = 8;  // after the fingerprint
    std::uint32_t root = 0;
    if (!add({}, root) || !structure(type, root, 0)) return false;
    if (offset_ != m_.bytes_.size()) {
      return fail("", std::to_string(remaining()) + " bytes follow the last field");
    }
    return true;
  }

  DecodeError error() const { return {reason_, offset_}; }

 private:
  std::size_t remaining() const { return m_.bytes_.size() - offset_; }

  bool fail(const std::string& path, const std::string& what) {
    reason_ = path.empty() ? what : "'" + path + "': " + what;
    return false;
  }

  bool fail_at(std::uint32_t node, const std::string& what) {
    std::string path;
    m_.append_path(node, path);
    return fail(path, what);
  }

  bool add(Node node, std::uint32_t& index) {
    if (m_.nodes_.size() == kMaximumNodes) {
      return fail_at(node.parent, "more than " + std::to_string(kMaximumNodes) + " fields");
    }
    index = static_cast<std::uint32_t>(m_.nodes_.size());
    node.offset = static_cast<std::uint32_t>(offset_);
    node.end = index + 1;
    m_.nodes_.push_back(node);
    return true;
  }

  bool structure(const Type& type, std::uint32_t node, int depth) {
    if (depth > kMaximumDepth) return fail_at(node, "nested too deeply");
    const std::size_t counters = m_.counters_.size();
    m_.counters_.resize(counters + static_cast<std::size_t>(type.counters));
    for (const Member& member : type.members) {
      if (!field(member, node, counters, depth)) return false;
    }
    m_.counters_.resize(counters);
    m_.nodes_[node].end = static_cast<std::uint32_t>(m_.nodes_.size());
    return true;
  }

  bool field(const Member& member, std::uint32_t parent, std::size_t counters, int depth) {
    std::uint32_t node = 0;
    if (!add({.member = &member, .parent = parent}, node)) return false;
    if (!member.dimensions.empty()) return array(member, node, counters, depth);
    if (!single(member, node, depth)) return false;
    if (member.counter >= 0) {
      m_.counters_[counters + static_cast<std::size_t>(member.counter)] =
          integer(member.kind, m_.bytes_.data() + m_.nodes_[node].offset);
    }
    return true;
  }

  bool single(const Member& member, std::uint32_t node, int depth) {
    if (member.kind == Kind::structure) return structure(*member.type, node, depth + 1);
    if (member.kind == Kind::string) return string(node);
    return numbers(member, node, 1);
  }

  bool numbers(const Member& member, std::uint32_t node, std::uint64_t count) {
    const std::size_t size = encoded_size(member.kind);
    if (count > remaining() / size) {
      return fail_at(node, "needs " + std::to_string(count * size) + " bytes, the message has " +
                               std::to_string(remaining()) + " more");
    }
    m_.nodes_[node].count = static_cast<std::uint32_t>(count);
    offset_ += count * size;
    return true;
  }

  bool string(std::uint32_t node) {
    if (remaining() < 4) return fail_at(node, "the message ends inside the length of a string");
    const std::int64_t length = integer(Kind::int32, m_.bytes_.data() + offset_);
    if (length < 1) return fail_at(node, "a string of " + std::to_string(length) + " bytes");
    if (static_cast<std::uint64_t>(length) > remaining() - 4) {
      return fail_at(node, "a string of " + std::to_string(length) + " bytes, the message has " +
                               std::to_string(remaining() - 4) + " more");
    }
    offset_ += 4 + static_cast<std::size_t>(length);
    if (m_.bytes_[offset_ - 1] != 0) return fail_at(node, "a string without its closing zero");
    m_.nodes_[node].count = 1;
    return true;
  }

  bool array(const Member& member, std::uint32_t node, std::size_t counters, int depth) {
    m_.nodes_[node].first_size = static_cast<std::uint32_t>(m_.sizes_.size());
    std::uint64_t count = 1;
    for (const Dimension& dimension : member.dimensions) {
      const std::int64_t size =
          dimension.size > 0 ? dimension.size
                             : m_.counters_[counters + static_cast<std::size_t>(dimension.counter)];
      if (size < 0) {
        return fail_at(node, "'" + dimension.text + "' gives it the size " + std::to_string(size));
      }
      // Both factors are at most 2^31, so their product fits into 64 bits.
      count *= static_cast<std::uint64_t>(std::min<std::int64_t>(size, std::int64_t{1} << 31));
      if (count > kMaximumBytes) return fail_at(node, "its sizes are beyond any message");
      m_.sizes_.push_back(static_cast<std::uint32_t>(size));
    }
    if (member.kind != Kind::structure && member.kind != Kind::string) {
      return numbers(member, node, count);
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      std::uint32_t element = 0;
      if (!add({.member = &member, .parent = node, .element = static_cast<std::int32_t>(i)},
               element) ||
          !single(member, element, depth)) {
        return false;
      }
    }
    m_.nodes_[node].end = static_cast<std::uint32_t>(m_.nodes_.size());
    return true;
  }

  DecodedMessage& m_;
  std::size_t offset_ = 0;
  std::string reason_;
};

std::optional<DecodeError> DecodedMessage::decode(const Type& type,
                                                  std::span<const std::uint8_t> bytes) {
  type_ = &type;
  bytes_ = bytes;
  nodes_.clear();
  sizes_.clear();
  counters_.clear();
  if (bytes.size() < 8) return DecodeError{"shorter than a fingerprint", 0};
  if (bytes.size() > kMaximumBytes) return DecodeError{"longer than 2 GB", 0};
  if (fingerprint_of(bytes) != type.fingerprint) {
    return DecodeError{"its fingerprint is not that of " + type.name, 0};
  }
  Decoding decoding(*this);
  if (decoding.message(type)) return std::nullopt;
  nodes_.clear();
  return decoding.error();
}

void DecodedMessage::append_index(std::size_t array, std::uint32_t index, std::string& path) const {
  std::uint64_t below = 1;  // elements of one index of the current dimension
  for (const std::uint32_t size : sizes(array)) below *= size;
  for (const std::uint32_t size : sizes(array)) {
    below /= size;
    path += '[' + std::to_string(index / below) + ']';
    index = static_cast<std::uint32_t>(index % below);
  }
}

void DecodedMessage::append_path(std::size_t node, std::string& path) const {
  const Node& n = nodes_[node];
  if (n.member == nullptr) return;
  append_path(n.parent, path);
  if (n.element >= 0) {
    append_index(n.parent, static_cast<std::uint32_t>(n.element), path);
  } else {
    if (!path.empty()) path += '.';
    path += n.member->name;
  }
}

std::string DecodedMessage::path(std::size_t node, std::uint32_t index) const {
  std::string path;
  append_path(node, path);
  if (!sizes(node).empty() && nodes_[node].count > 0) append_index(node, index, path);
  return path;
}

std::span<const std::uint32_t> DecodedMessage::sizes(std::size_t node) const {
  const Node& n = nodes_[node];
  if (n.member == nullptr || n.element >= 0) return {};
  return std::span(sizes_).subspan(n.first_size, n.member->dimensions.size());
}

std::span<const std::uint8_t> DecodedMessage::encoded(std::size_t node, std::uint32_t index) const {
  const Node& n = nodes_[node];
  if (n.member->kind == Kind::string) {
    const auto length = static_cast<std::size_t>(integer(Kind::int32, bytes_.data() + n.offset));
    return bytes_.subspan(n.offset + 4, length - 1);
  }
  const std::size_t size = encoded_size(n.member->kind);
  return bytes_.subspan(n.offset + index * size, size);
}

Value DecodedMessage::value(std::size_t node, std::uint32_t index) const {
  const std::span<const std::uint8_t> bytes = encoded(node, index);
  switch (const Kind kind = nodes_[node].member->kind) {
    case Kind::string:
      return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    case Kind::float32:
      return std::bit_cast<float>(big_endian<std::uint32_t>(bytes.data()));
    case Kind::float64:
      return std::bit_cast<double>(big_endian<std::uint64_t>(bytes.data()));
    case Kind::boolean:
      if (bytes[0] <= 1) return bytes[0] == 1;
      [[fallthrough]];
    default:
      return integer(kind, bytes.data());
  }
}

}  // namespace maploop::schema
