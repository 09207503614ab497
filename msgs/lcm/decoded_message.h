// This file reads one encoded message by its type: a tree of fields with exact values.
//
//   const Type* type = schema.find(fingerprint_of(bytes));
//   if (type != nullptr) {
//     const Field message = decode(*type, bytes);
//     for (const Field& field : message.inner)
//       for (std::size_t i = 0; i < field.count(); ++i)
//         std::cout << field.name() << index_text(field, i) << " = " << field.text(i) << '\n';
//   }
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "msgs/lcm/schema.h"

namespace maploop::schema {

// A boolean that is neither 0 nor 1 is given as its number.
using Value = std::variant<std::int64_t, float, double, bool, std::string_view>;

// A field is one of these: a number, a text or an array of numbers, with values of its own; a
// struct, or an array of structs or texts, with fields inside.
struct Field {
  const Member* member = nullptr;      // null for the message itself; an element has its array's
  std::vector<std::size_t> sizes;      // of an array, outermost first; otherwise empty
  std::span<const std::uint8_t> data;  // its own values as encoded; a text without its closing zero
  std::vector<Field> inner;            // members of a struct, or elements of an array

  const std::string& name() const { return member->name; }
  // Returns the number of its own values.
  std::size_t count() const;
  // Precondition of all members below: index < count().
  std::span<const std::uint8_t> encoded(std::size_t index = 0) const;
  Value value(std::size_t index = 0) const;
  // Returns a number as the shortest text that gives the same bits back, and a string in quotes
  // with unprintable characters as \xNN.
  std::string text(std::size_t index = 0) const;
};

// Returns "[1][2]" for an element of an array, by its number; nothing if the field is not an array.
std::string index_text(const Field& field, std::size_t index);

// Returns the path of a field inside another whose path is given: "threads[3]", "threads[3].name".
std::string inner_path(const Field& field, std::size_t inner, const std::string& path);

// The text contains the path of the field.
class DecodeError : public std::runtime_error {
 public:
  DecodeError(const std::string& reason, std::size_t offset)
      : std::runtime_error(reason), offset_(offset) {}
  std::size_t offset() const { return offset_; }  // of the byte of the message with the error

 private:
  std::size_t offset_;
};

// The whole message must be of the type, from its fingerprint to the last byte. The bytes, and the
// schema that contains the type, must outlive the result. Throws DecodeError: sizes that exceed the
// message are refused before memory is allocated for them, and so are more than a million fields
// and structs nested deeper than 64.
Field decode(const Type& type, std::span<const std::uint8_t> bytes);

// Returns nothing if the bytes are not a message of a type of the schema.
std::optional<Field> try_decode(const Schema& schema, std::span<const std::uint8_t> bytes);

}  // namespace maploop::schema
