// This file represents LCM types as data, as .lcm files declare them, so that a message can be
// read without code generated for it: the types of msgs/lcm, which are part of the program, and
// those that a user names.
//
// The language is that of lcm-gen 1.3.1: packages, structs, arrays of fixed and variable size,
// nested types. Constants are skipped: no message contains them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace maploop::schema {

enum class Kind : std::uint8_t {
  int8,
  int16,
  int32,
  int64,
  byte,
  boolean,
  float32,
  float64,
  string,
  structure
};

// Returns the bytes of one encoded value; 0 for string and structure, whose size varies.
std::size_t encoded_size(Kind kind);

struct Type;

struct Dimension {
  std::string text;       // as declared: a number or the name of the member that holds the size
  std::int64_t size = 0;  // fixed size; 0 if variable
  int counter = -1;       // if variable: the counter of the struct that holds the size
};

struct Member {
  std::string name;
  std::string type_name;  // "double", "maploop_lcm.header_t"
  Kind kind = Kind::int8;
  const Type* type = nullptr;         // if it is a structure
  std::vector<Dimension> dimensions;  // outermost first; empty if not an array
  int counter = -1;                   // counter number in the struct; -1 if not a counter
  std::string where;                  // "FILE:LINE: " of its declaration
};

struct Type {
  std::string name;  // with its package: "maploop_lcm.imu_t"
  std::vector<Member> members;
  int counters = 0;               // members that size an array
  std::uint64_t fingerprint = 0;  // as LCM puts it in front of each message of this type
  std::string where;              // "FILE:LINE: " of its declaration
};

// This is the text of one .lcm file; `source` names it in errors.
struct TypeText {
  std::string source;
  std::string text;
};

// A schema is immutable, so any thread may use it.
class Schema {
 public:
  // The order of the texts does not matter. The same type may be declared twice if both
  // declarations agree. Throws std::runtime_error that names source and line and states what is
  // wrong: text outside the language, a type that no text declares, or two different types of one
  // name.
  explicit Schema(std::span<const TypeText> texts);

  // These return null if there is no such type. LCM's fingerprint does not cover the name of a
  // type: of two types that differ only in name, the one declared first is returned.
  const Type* find(std::uint64_t fingerprint) const;
  const Type* find(std::string_view name) const;

  // Returns the number of types.
  std::size_t size() const { return types_.size(); }

 private:
  std::vector<std::unique_ptr<Type>> types_;
  std::unordered_map<std::uint64_t, const Type*> by_fingerprint_;
};

// Returns the texts of msgs/lcm, which are part of the program.
std::span<const TypeText> own_types();

// Returns the types that a text declares, without Member::type and fingerprint. Throws
// std::runtime_error with the text "FILE:LINE: what is wrong".
std::vector<std::unique_ptr<Type>> parse_types(const TypeText& text);

// Returns the fingerprint in front of an encoded message; 0 if it is too short to have one.
std::uint64_t fingerprint_of(std::span<const std::uint8_t> message);

}  // namespace maploop::schema
