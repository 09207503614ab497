#include <fmt/format.h>

#include <algorithm>

#include "msgs/lcm/decoded_message.h"
#include "tools/log/log_tools.h"

namespace maploop::lcm_log {
namespace {

using Bytes = std::span<const std::uint8_t>;
using schema::Field;

std::string hex(Bytes bytes) {
  return fmt::format("0x{:02x}", fmt::join(bytes, ""));
}

bool same(Bytes a, Bytes b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

std::string type_text(Bytes message, const schema::Type* type) {
  if (type != nullptr) return type->name;
  return "unknown type " + hex(message.first(std::min<std::size_t>(message.size(), 8)));
}

FieldDifference first_byte(Bytes a, Bytes b) {
  const auto [at_a, at_b] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  const auto at = static_cast<std::size_t>(at_a - a.begin());
  const auto text = [at](Bytes bytes) {
    if (at < bytes.size()) return hex(bytes.subspan(at, 1));
    return "nothing: " + std::to_string(bytes.size()) + " bytes in all";
  };
  return {"byte " + std::to_string(at), text(a), text(b)};
}

// The size of an array is a field before the array itself. Up to the first difference both trees
// therefore have the same shape.
std::optional<FieldDifference> first_field(const Field& a, const Field& b,
                                           const std::string& path) {
  for (std::size_t i = 0; i < std::min(a.count(), b.count()); ++i) {
    if (same(a.encoded(i), b.encoded(i))) continue;
    FieldDifference difference{path + index_text(a, i), a.text(i), b.text(i)};
    // Different bits may have the same text, for instance NaNs; then the bits are shown as well.
    if (difference.a == difference.b) {
      difference.a += " (" + hex(a.encoded(i)) + ")";
      difference.b += " (" + hex(b.encoded(i)) + ")";
    }
    return difference;
  }
  for (std::size_t i = 0; i < std::min(a.inner.size(), b.inner.size()); ++i) {
    if (auto found = first_field(a.inner[i], b.inner[i], inner_path(a, i, path))) return found;
  }
  return std::nullopt;
}

}  // namespace

std::optional<FieldDifference> compare(Bytes a, Bytes b, const schema::Schema& schema) {
  if (same(a, b)) return std::nullopt;
  const schema::Type* type = schema.find(schema::fingerprint_of(a));
  const schema::Type* type_b = schema.find(schema::fingerprint_of(b));
  if (schema::fingerprint_of(a) != schema::fingerprint_of(b)) {
    return FieldDifference{"type", type_text(a, type), type_text(b, type_b)};
  }
  if (type != nullptr) {
    try {
      if (auto field = first_field(decode(*type, a), decode(*type, b), "")) return field;
    } catch (const schema::DecodeError&) {
      return first_byte(a, b);
    }
  }
  return first_byte(a, b);
}

}  // namespace maploop::lcm_log
