#include <fmt/format.h>
#include <algorithm>

#include "msgs/lcm/decoded_message.h"
#include "tools/log/log_diff.h"
#include "tools/log/log_text.h"

namespace maploop::lcm_log {
namespace {

using Bytes = std::span<const std::uint8_t>;
using schema::DecodedMessage;

std::string hex(Bytes bytes) {
  std::string text = "0x";
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
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

// Different bits may have the same text, for instance NaNs; then the bits are shown as well.
std::string value_text(const DecodedMessage& message, std::size_t node, std::uint32_t index,
                       bool with_bits) {
  std::string text = message.text(node, index);
  if (with_bits) text += " (" + hex(message.encoded(node, index)) + ")";
  return text;
}

// The size of an array is a field before the array itself. Up to the first difference both trees
// therefore have the same shape.
std::optional<FieldDifference> first_field(const DecodedMessage& a, const DecodedMessage& b) {
  const std::size_t nodes = std::min(a.nodes().size(), b.nodes().size());
  for (std::size_t node = 0; node < nodes; ++node) {
    const std::uint32_t count = std::min(a.nodes()[node].count, b.nodes()[node].count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Bytes of_a = a.encoded(node, i), of_b = b.encoded(node, i);
      if (std::equal(of_a.begin(), of_a.end(), of_b.begin(), of_b.end())) continue;
      const bool alike = a.text(node, i) == b.text(node, i);
      return FieldDifference{a.path(node, i), value_text(a, node, i, alike),
                             value_text(b, node, i, alike)};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<FieldDifference> compare(Bytes a, Bytes b, const schema::Schema& schema) {
  if (std::equal(a.begin(), a.end(), b.begin(), b.end())) return std::nullopt;
  const std::uint64_t fingerprint = schema::fingerprint_of(a);
  const schema::Type* type = schema.find(fingerprint);
  if (fingerprint != schema::fingerprint_of(b)) {
    return FieldDifference{"type", type_text(a, type),
                           type_text(b, schema.find(schema::fingerprint_of(b)))};
  }
  DecodedMessage message_a, message_b;
  if (type == nullptr || message_a.decode(*type, a) || message_b.decode(*type, b)) {
    return first_byte(a, b);
  }
  if (auto field = first_field(message_a, message_b)) return field;
  return first_byte(a, b);
}

}  // namespace maploop::lcm_log
