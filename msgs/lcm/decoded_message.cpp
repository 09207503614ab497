#include "msgs/lcm/decoded_message.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>

namespace maploop::schema {
namespace {

constexpr std::size_t maximum_bytes = std::size_t{1} << 31;
constexpr std::size_t maximum_fields = 1'000'000;
constexpr int maximum_depth = 64;

std::uint64_t big_endian(std::span<const std::uint8_t> bytes) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

std::int64_t integer(Kind kind, std::span<const std::uint8_t> bytes) {
  const std::uint64_t value = big_endian(bytes);
  switch (kind) {
    case Kind::byte:
      return static_cast<std::int64_t>(value);
    case Kind::int16:
      return static_cast<std::int16_t>(value);
    case Kind::int32:
      return static_cast<std::int32_t>(value);
    case Kind::int64:
      return static_cast<std::int64_t>(value);
    default:
      return static_cast<std::int8_t>(value);
  }
}

std::string quoted(std::string_view text) {
  constexpr std::string_view hexadecimal_digits = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<std::uint8_t>(c);
    if (byte < 0x20 || byte == 0x7f) {
      result += "\\x";
      result += hexadecimal_digits[byte >> 4];
      result += hexadecimal_digits[byte & 15];
    } else {
      if (c == '"' || c == '\\') result += '\\';
      result += c;
    }
  }
  return result + '"';
}

// Makes one pass over the bytes.
class Decoder {
 public:
  explicit Decoder(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  Field message(const Type& type) {
    Field message;
    try {
      if (bytes_.size() > maximum_bytes) fail("longer than 2 GB");
      if (bytes_.size() < 8) fail("shorter than a fingerprint");
      if (fingerprint_of(bytes_) != type.fingerprint) {
        fail("its fingerprint is not that of " + type.name);
      }
      take(8);
      structure(type, message, 0);
      if (left() > 0) fail(std::to_string(left()) + " bytes follow the last field");
    } catch (const Failure& failure) {
      throw DecodeError(
          failure.path.empty() ? failure.reason : "'" + failure.path + "': " + failure.reason,
          offset_);
    }
    return message;
  }

 private:
  struct Failure {
    std::string reason;
    std::string path;  // grows from the innermost field on
  };
  [[noreturn]] void fail(const std::string& what) const { throw Failure{what, {}}; }

  std::size_t left() const { return bytes_.size() - offset_; }

  std::span<const std::uint8_t> take(std::size_t count) {
    const auto taken = bytes_.subspan(offset_, count);
    offset_ += count;
    return taken;
  }

  Field& add(std::vector<Field>& fields, const Member& member) {
    if (++fields_ >= maximum_fields) {
      fail("more than " + std::to_string(maximum_fields) + " fields");
    }
    return fields.emplace_back(Field{&member, {}, {}, {}});
  }

  void structure(const Type& type, Field& to, int depth) {
    if (depth > maximum_depth) fail("nested too deeply");
    std::vector<std::int64_t> counters(static_cast<std::size_t>(type.counters));
    to.inner.reserve(type.members.size());
    for (const Member& member : type.members) {
      try {
        Field& field = add(to.inner, member);
        if (member.dimensions.empty()) {
          single(field, depth);
        } else {
          array(field, counters, depth);
        }
        if (member.counter >= 0) {
          counters[static_cast<std::size_t>(member.counter)] = integer(member.kind, field.data);
        }
      } catch (Failure& failure) {
        const bool name_follows = !failure.path.empty() && failure.path[0] != '[';
        failure.path.insert(0, member.name + (name_follows ? "." : ""));
        throw;
      }
    }
  }

  void single(Field& field, int depth) {
    if (field.member->kind == Kind::structure) {
      structure(*field.member->type, field, depth + 1);
    } else if (field.member->kind == Kind::string) {
      string(field);
    } else {
      numbers(field, 1);
    }
  }

  void numbers(Field& field, std::size_t count) {
    const std::size_t size = encoded_size(field.member->kind);
    if (count > left() / size) {
      fail("needs " + std::to_string(count * size) + " bytes, the message has " +
           std::to_string(left()) + " more");
    }
    field.data = take(count * size);
  }

  void string(Field& field) {
    if (left() < 4) fail("the message ends inside the length of a string");
    const std::int64_t length = integer(Kind::int32, take(4));
    if (length < 1) fail("a string of " + std::to_string(length) + " bytes");
    if (static_cast<std::size_t>(length) > left()) {
      fail("a string of " + std::to_string(length) + " bytes, the message has " +
           std::to_string(left()) + " more");
    }
    field.data = take(static_cast<std::size_t>(length));
    if (field.data.back() != 0) fail("a string without its closing zero");
    field.data = field.data.first(field.data.size() - 1);
  }

  void array(Field& field, const std::vector<std::int64_t>& counters, int depth) {
    std::size_t count = 1;
    for (const Dimension& dimension : field.member->dimensions) {
      const std::int64_t size = dimension.size > 0
                                    ? dimension.size
                                    : counters[static_cast<std::size_t>(dimension.counter)];
      if (size < 0) fail("'" + dimension.text + "' gives it the size " + std::to_string(size));
      // Both factors are at most 2^31, so their product fits into 64 bits.
      count *= static_cast<std::size_t>(std::min<std::int64_t>(size, std::int64_t{1} << 31));
      if (count > maximum_bytes) fail("its sizes are beyond any message");
      field.sizes.push_back(static_cast<std::size_t>(size));
    }
    if (field.member->kind < Kind::string) return numbers(field, count);
    for (std::size_t i = 0; i < count; ++i) {
      Field& element = add(field.inner, *field.member);
      try {
        single(element, depth);
      } catch (Failure& failure) {
        const bool name_follows = !failure.path.empty();
        failure.path.insert(0, index_text(field, i) + (name_follows ? "." : ""));
        throw;
      }
    }
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t offset_ = 0;
  std::size_t fields_ = 0;
};

}  // namespace

Field decode(const Type& type, std::span<const std::uint8_t> bytes) {
  return Decoder(bytes).message(type);
}

std::optional<Field> try_decode(const Schema& schema, std::span<const std::uint8_t> bytes) {
  const Type* type = schema.find(fingerprint_of(bytes));
  if (type == nullptr) return std::nullopt;
  try {
    return decode(*type, bytes);
  } catch (const DecodeError&) {
    return std::nullopt;
  }
}

std::size_t Field::count() const {
  if (member == nullptr || member->kind == Kind::structure) return 0;
  if (member->kind == Kind::string) return sizes.empty() ? 1 : 0;
  return data.size() / encoded_size(member->kind);
}

std::span<const std::uint8_t> Field::encoded(std::size_t index) const {
  if (member->kind == Kind::string) return data;
  const std::size_t size = encoded_size(member->kind);
  return data.subspan(index * size, size);
}

Value Field::value(std::size_t index) const {
  const std::span<const std::uint8_t> bytes = encoded(index);
  switch (member->kind) {
    case Kind::string:
      return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    case Kind::float32:
      return std::bit_cast<float>(static_cast<std::uint32_t>(big_endian(bytes)));
    case Kind::float64:
      return std::bit_cast<double>(big_endian(bytes));
    case Kind::boolean:
      if (bytes[0] <= 1) return bytes[0] == 1;
      [[fallthrough]];
    default:
      return integer(member->kind, bytes);
  }
}

std::string Field::text(std::size_t index) const {
  const auto to_text = [](const auto& v) -> std::string {
    using T = std::decay_t<decltype(v)>;
    if constexpr (std::is_same_v<T, std::string_view>) {
      return quoted(v);
    } else if constexpr (std::is_same_v<T, bool>) {
      return v ? "true" : "false";
    } else {
      std::array<char, 40> text{};
      return {text.begin(), std::to_chars(text.begin(), text.end(), v).ptr};
    }
  };
  return std::visit(to_text, value(index));
}

std::string index_text(const Field& field, std::size_t index) {
  std::string text;
  for (auto size = field.sizes.rbegin(); size != field.sizes.rend(); ++size) {
    text.insert(0, '[' + std::to_string(index % *size) + ']');
    index /= *size;
  }
  return text;
}

std::string inner_path(const Field& field, std::size_t inner, const std::string& path) {
  if (!field.sizes.empty()) return path + index_text(field, inner);
  return path + (path.empty() ? "" : ".") + field.inner[inner].name();
}

}  // namespace maploop::schema
