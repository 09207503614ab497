// This file parses the .lcm language, one text at a time; Schema resolves the names of other types.
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <utility>

#include "msgs/lcm/schema.h"

namespace maploop::schema {
namespace {

// In the order of Kind; every other name is that of a structure.
constexpr std::array<std::string_view, 9> primitive_types{
    "int8_t", "int16_t", "int32_t", "int64_t", "byte", "boolean", "float", "double", "string"};

Kind kind_of(std::string_view name) {
  return static_cast<Kind>(std::find(primitive_types.begin(), primitive_types.end(), name) -
                           primitive_types.begin());
}

bool is_name_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool is_word_character(char c) {
  return is_name_character(c) || c == '.' || c == '+' || c == '-';
}

// A name may consist of parts with dots between them, such as a package and a type.
bool is_name(std::string_view text) {
  bool part_begins = true;
  for (const char c : text) {
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (part_begins ? digit || !is_name_character(c) : c != '.' && !is_name_character(c)) {
      return false;
    }
    part_begins = c == '.';
  }
  return !part_begins;
}

class Parser {
 public:
  explicit Parser(const TypeText& text) : source_(text.source), rest_(text.text) { advance(); }

  std::vector<std::unique_ptr<Type>> parse() {
    std::string package;
    while (!word_.empty()) {
      if (take("package")) {
        package = name() + '.';
        require(";");
      } else if (take("struct")) {
        types_.push_back(parse_struct(package));
      } else {
        fail("'struct' or 'package' is missing before " + shown());
      }
    }
    return std::move(types_);
  }

 private:
  std::string where() const { return source_ + ':' + std::to_string(line_) + ": "; }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(where() + what);
  }

  // Returns the current word as an error message may show it.
  std::string shown() const {
    if (word_.empty()) return "the end of the file";
    std::string text(word_.substr(0, 60));
    for (char& c : text) c = std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
    return '\'' + text + '\'';
  }

  // Returns the number of characters of the blank or comment that comes next.
  std::size_t blank() const {
    if (rest_.starts_with("//")) return std::min(rest_.find('\n'), rest_.size());
    if (rest_.starts_with("/*")) {
      const std::size_t end = rest_.find("*/", 2);
      if (end == std::string_view::npos) fail("this comment has no end");
      return end + 2;
    }
    return !rest_.empty() && std::isspace(static_cast<unsigned char>(rest_[0])) != 0 ? 1 : 0;
  }

  // Goes to the next word: a name, a number or a single character; empty at the end.
  void advance() {
    for (std::size_t size = blank(); size > 0; size = blank()) {
      const std::string_view skipped = rest_.substr(0, size);
      line_ += static_cast<int>(std::count(skipped.begin(), skipped.end(), '\n'));
      rest_.remove_prefix(size);
    }
    const auto end = std::find_if_not(rest_.begin(), rest_.end(), is_word_character);
    const auto length = static_cast<std::size_t>(end - rest_.begin());
    word_ = rest_.substr(0, std::max<std::size_t>(length, 1));
    rest_.remove_prefix(word_.size());
  }

  bool take(std::string_view text) {
    if (word_ != text) return false;
    advance();
    return true;
  }

  void require(std::string_view text) {
    if (!take(text)) fail('\'' + std::string(text) + "' is missing before " + shown());
  }

  std::string name() {
    if (!is_name(word_)) fail(shown() + " is not a name");
    std::string text(word_);
    advance();
    return text;
  }

  std::unique_ptr<Type> parse_struct(const std::string& package) {
    auto type = std::make_unique<Type>();
    type->where = where();
    type->name = package + name();
    require("{");
    while (!take("}")) {
      if (take("const")) {
        while (!word_.empty() && word_ != ";") advance();
        require(";");
      } else {
        parse_members(package, *type);
      }
    }
    return type;
  }

  void parse_members(const std::string& package, Type& type) {
    std::string of = name();
    const Kind kind = kind_of(of);
    if (kind == Kind::structure && of.find('.') == std::string::npos) of.insert(0, package);
    do {
      Member member;
      member.where = where();
      member.name = name();
      member.kind = kind;
      member.type_name = of;
      while (take("[")) {
        member.dimensions.push_back(parse_dimension(type));
        require("]");
      }
      type.members.push_back(std::move(member));
    } while (take(","));
    require(";");
  }

  Dimension parse_dimension(Type& type) {
    Dimension dimension;
    dimension.text = word_;
    const auto counter =
        std::find_if(type.members.begin(), type.members.end(), [&](const Member& m) {
          return m.name == word_ && m.dimensions.empty() && m.kind <= Kind::int64;
        });
    if (counter != type.members.end()) {
      if (counter->counter < 0) counter->counter = type.counters++;
      dimension.counter = counter->counter;
    } else {
      char* end = nullptr;
      // lcm-gen accepts 0x10 and 010 too.
      dimension.size = std::strtoll(dimension.text.c_str(), &end, 0);
      if (*end != '\0' || dimension.size < 1 ||
          dimension.size > std::numeric_limits<std::int32_t>::max()) {
        fail(shown() +
             " is not the size of an array: a number from 1 to 2^31-1, or an integer "
             "member declared before it");
      }
    }
    advance();
    return dimension;
  }

  std::string source_;
  std::string_view rest_;  // after the current word
  std::string_view word_;
  int line_ = 1;
  std::vector<std::unique_ptr<Type>> types_;
};

}  // namespace

std::vector<std::unique_ptr<Type>> parse_types(const TypeText& text) {
  return Parser(text).parse();
}

}  // namespace maploop::schema
