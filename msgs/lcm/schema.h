// This file represents LCM types as data, as a .lcm file declares them, so that a message can be
// read without code generated for it.
//
// The language is that of lcm-gen 1.3.1 (packages, structs, constants, arrays of fixed and variable
// size, nested types). An `enum` is refused; lcm-gen does not make C++ code for it either.
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
  std::int64_t size = 0;  // fixed size; 0 if variable
  int counter = -1;       // if variable: the counter of the struct that holds the size
  std::string text;       // as declared: a number or the counter's name
};

struct Member {
  std::string name;
  std::string type_name;  // "double", "maploop_lcm.header_t"
  Kind kind = Kind::int8;
  const Type* type = nullptr;         // if it is a structure
  std::vector<Dimension> dimensions;  // outermost first; empty if not an array
  int counter = -1;                   // counter number in the struct; -1 if not a counter
};

struct Constant {
  std::string name;
  Kind kind = Kind::int8;
  std::string value;  // as declared
};

struct Type {
  std::string name;  // with its package: "maploop_lcm.imu_t"
  std::vector<Member> members;
  std::vector<Constant> constants;
  int counters = 0;               // members that size an array
  std::uint64_t fingerprint = 0;  // as LCM puts it in front of each message of this type
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

  // Returns the types in the order of declaration.
  std::span<const std::unique_ptr<const Type>> types() const { return types_; }

 private:
  std::vector<std::unique_ptr<const Type>> types_;
  std::unordered_map<std::uint64_t, const Type*> by_fingerprint_;
};

// Returns the types of msgs/lcm, which are part of the program.
std::span<const TypeText> own_types();

// Returns LCM's own recursive hash of a type whose members are resolved. Throws std::runtime_error
// if its types are nested too deeply.
std::uint64_t fingerprint_of(const Type& type);

// Returns the fingerprint in front of an encoded message; 0 if it is too short to have one.
std::uint64_t fingerprint_of(std::span<const std::uint8_t> message);

}  // namespace maploop::schema
