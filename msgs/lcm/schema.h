// LCM types as data: what a .lcm file declares, so that a message can be read without code
// generated for it.
//
// The language is that of lcm-gen 1.3.1 (packages, structs, constants, arrays of fixed and variable
// size, nested types). An `enum` is refused, for which lcm-gen makes no C++ code either.
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

// Bytes of one encoded value; 0 for string and structure, whose size is their own.
std::size_t encoded_size(Kind kind);

struct Type;

struct Dimension {
  std::int64_t size = 0;  // fixed size; 0: variable
  int counter = -1;       // variable: which counter of the struct holds the size
  std::string text;       // as declared: a number or the counter's name
};

struct Member {
  std::string name;
  std::string type_name;  // "double", "maploop_lcm.header_t"
  Kind kind = Kind::int8;
  const Type* type = nullptr;         // of a structure
  std::vector<Dimension> dimensions;  // outermost first; empty: not an array
  int counter = -1;                   // which counter of its struct it is; -1: it sizes no array
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
  std::uint64_t fingerprint = 0;  // what LCM puts in front of each message of this type
};

// The text of one .lcm file; `source` names it in errors.
struct TypeText {
  std::string source;
  std::string text;
};

// Immutable once made: any thread may use it.
class Schema {
 public:
  // The order of the texts does not matter. The same type may be declared twice if both mean the
  // same. Throws std::runtime_error naming source, line and what is wrong there: text that is not
  // the language, a type that no text declares, or two different types of one name.
  explicit Schema(std::span<const TypeText> texts);

  // Null where there is none. LCM's fingerprint does not cover the name of a type: of two types
  // alike but for their name, the one declared first is found.
  const Type* find(std::uint64_t fingerprint) const;
  const Type* find(std::string_view name) const;

  // In the order of declaration.
  std::span<const std::unique_ptr<const Type>> types() const { return types_; }

 private:
  std::vector<std::unique_ptr<const Type>> types_;
  std::unordered_map<std::uint64_t, const Type*> by_fingerprint_;
};

// The types of msgs/lcm, which are part of the program.
std::span<const TypeText> own_types();

// LCM's own recursive hash of a type whose members are resolved. Throws std::runtime_error when its
// types are nested beyond reason.
std::uint64_t fingerprint_of(const Type& type);

// The fingerprint in front of an encoded message; 0 when it is too short to have one.
std::uint64_t fingerprint_of(std::span<const std::uint8_t> message);

}  // namespace maploop::schema
