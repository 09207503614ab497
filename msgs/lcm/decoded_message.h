// This file reads one encoded message by its type: a tree of fields with exact values.
//
//   DecodedMessage message;                      // reused from message to message
//   const Type* type = schema.find(fingerprint_of(bytes));
//   if (type && !message.decode(*type, bytes)) {
//     for (std::size_t n = 0; n < message.nodes().size(); ++n)
//       for (std::uint32_t i = 0; i < message.nodes()[n].count; ++i)
//         std::cout << message.path(n, i) << " = " << message.text(n, i) << '\n';
//   }
//
// Decoding only finds where each field is; values are read on request. An array of numbers is one
// node, whatever its size. Nothing is allocated once the vectors have grown to the largest message,
// except the texts that a caller requests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "msgs/lcm/schema.h"

namespace maploop::schema {

// A boolean that is neither 0 nor 1 is given as its number.
using Value = std::variant<std::int64_t, float, double, bool, std::string_view>;

// Returns numbers as the shortest text that gives the same bits back, and strings in quotes with
// unprintable characters as \xNN.
std::string to_text(const Value& value);

// Nodes are in the order of the message, each before those below it.
struct Node {
  const Member* member = nullptr;  // null for the message itself
  std::uint32_t parent = 0;        // 0 for the message itself
  std::uint32_t end = 0;           // the node after the last one below this one
  std::uint32_t offset = 0;        // of its first byte in the message
  std::uint32_t count = 0;         // number of its own values; 0 if the nodes below have them
  std::int32_t element = -1;       // number in its parent, an array; -1: no element
  std::uint32_t first_size = 0;    // where an array's sizes begin
};

struct DecodeError {
  std::string reason;  // contains the field's name
  std::size_t offset;  // byte of the message with the error
};

class DecodedMessage {
 public:
  // The bytes, and the schema that contains the type, must outlive the use of this message. The
  // whole message must be of the type, from its fingerprint to the last byte. After an error there
  // are no nodes. Arrays whose sizes exceed the message are refused before memory is allocated for
  // them; more than a million nodes and structs nested deeper than 64 are refused too.
  std::optional<DecodeError> decode(const Type& type, std::span<const std::uint8_t> bytes);

  // Precondition of all members below: decode() succeeded; node < nodes().size(); index < its
  // count.
  const Type& type() const { return *type_; }
  std::span<const Node> nodes() const { return nodes_; }

  // Returns "threads[3].p50_us", "covariance[0][8]", or nothing for the message itself.
  std::string path(std::size_t node, std::uint32_t index = 0) const;
  Value value(std::size_t node, std::uint32_t index = 0) const;
  std::string text(std::size_t node, std::uint32_t index = 0) const {
    return to_text(value(node, index));
  }
  // Returns the encoded bytes; a string without its length and its closing zero.
  std::span<const std::uint8_t> encoded(std::size_t node, std::uint32_t index = 0) const;

  // Returns the sizes of the array at a node, outermost first; empty if it is not an array.
  std::span<const std::uint32_t> sizes(std::size_t node) const;

 private:
  class Decoding;

  void append_path(std::size_t node, std::string& path) const;
  void append_index(std::size_t array, std::uint32_t index, std::string& path) const;

  const Type* type_ = nullptr;
  std::span<const std::uint8_t> bytes_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> sizes_;
  std::vector<std::int64_t> counters_;  // of the structs being decoded, outermost first
};

}  // namespace maploop::schema
