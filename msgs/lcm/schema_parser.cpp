#include "msgs/lcm/schema_parser.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <limits>
#include <optional>
#include <stdexcept>

namespace maploop::schema {
namespace {

struct Token {
  std::string_view text;  // empty at the end of the text
  int line = 1;
};

// Returns the text as an error message may show it.
std::string shown(std::string_view text) {
  if (text.empty()) return "the end of the file";
  std::string result = "'";
  for (const char c : text.substr(0, 60)) {
    result += std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
  }
  return result + "'";
}

bool is_word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '+' ||
         c == '-';
}

bool is_name(std::string_view text) {
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) == 0 &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
         });
}

// Accepts names joined by single dots.
bool is_qualified_name(std::string_view text) {
  while (true) {
    const std::size_t dot = text.find('.');
    if (!is_name(text.substr(0, dot))) return false;
    if (dot == std::string_view::npos) return true;
    text.remove_prefix(dot + 1);
  }
}

class Lexer {
 public:
  explicit Lexer(const TypeText& text) : source_(text.source), rest_(text.text) { advance(); }

  const Token& peek() const { return token_; }

  Token next() {
    const Token token = token_;
    advance();
    return token;
  }

  bool take(std::string_view text) {
    if (token_.text != text) return false;
    advance();
    return true;
  }

  void require(std::string_view text) {
    if (!take(text))
      fail(token_, "'" + std::string(text) + "' is missing before " + shown(token_.text));
  }

  [[noreturn]] void fail(const Token& where, const std::string& what) const {
    throw std::runtime_error(source_ + ":" + std::to_string(where.line) + ": " + what);
  }

 private:
  void drop(std::size_t count) {
    token_.line += static_cast<int>(
        std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(count), '\n'));
    rest_.remove_prefix(count);
  }

  void skip_blanks_and_comments() {
    while (!rest_.empty()) {
      if (std::isspace(static_cast<unsigned char>(rest_[0])) != 0) {
        drop(1);
      } else if (rest_.starts_with("//")) {
        drop(std::min(rest_.find('\n'), rest_.size()));
      } else if (rest_.starts_with("/*")) {
        const std::size_t end = rest_.find("*/", 2);
        if (end == std::string_view::npos) fail(token_, "this comment has no end");
        drop(end + 2);
      } else {
        return;
      }
    }
  }

  void advance() {
    drop(token_.text.size());
    token_.text = {};
    skip_blanks_and_comments();
    if (rest_.empty()) return;
    std::size_t length = 1;
    if (is_word_character(rest_[0])) {
      while (length < rest_.size() && is_word_character(rest_[length])) ++length;
    } else if (std::string_view("{}[];,=").find(rest_[0]) == std::string_view::npos) {
      fail(token_, shown(rest_.substr(0, 1)) + " has no meaning here");
    }
    token_.text = rest_.substr(0, length);
  }

  std::string source_;
  std::string_view rest_;  // from the current token on
  Token token_;
};

struct Primitive {
  std::string_view name;
  Kind kind;
};
constexpr std::array<Primitive, 9> kPrimitives{{{"int8_t", Kind::int8},
                                                {"int16_t", Kind::int16},
                                                {"int32_t", Kind::int32},
                                                {"int64_t", Kind::int64},
                                                {"byte", Kind::byte},
                                                {"boolean", Kind::boolean},
                                                {"float", Kind::float32},
                                                {"double", Kind::float64},
                                                {"string", Kind::string}}};

Kind kind_of(std::string_view name) {
  for (const Primitive& p : kPrimitives) {
    if (p.name == name) return p.kind;
  }
  return Kind::structure;
}

bool is_integer(Kind kind) {
  return kind <= Kind::int64;
}

std::optional<std::int64_t> to_integer(const std::string& text) {
  char* end = nullptr;
  errno = 0;
  const long long value = std::strtoll(text.c_str(), &end, 0);  // lcm-gen accepts 0x10 and 010 too
  if (errno != 0 || text.empty() || *end != '\0') return std::nullopt;
  return value;
}

bool is_constant_of(Kind kind, const std::string& text) {
  if (is_integer(kind)) {
    const auto value = to_integer(text);
    const int bits = static_cast<int>(8 * encoded_size(kind));
    return value && (*value >> (bits - 1) == 0 || *value >> (bits - 1) == -1);
  }
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0';
}

class Parser {
 public:
  explicit Parser(const TypeText& text) : source_(text.source), lexer_(text) {}

  std::vector<ParsedType> parse() {
    while (!lexer_.peek().text.empty()) {
      const Token start = lexer_.next();
      if (start.text == "package") {
        const Token name = lexer_.next();
        if (!is_qualified_name(name.text))
          lexer_.fail(name, shown(name.text) + " is no package name");
        package_ = name.text;
        lexer_.require(";");
      } else if (start.text == "struct") {
        types_.push_back(parse_struct());
      } else if (start.text == "enum") {
        lexer_.fail(start, "enum is not supported: write the values as constants of a struct");
      } else {
        lexer_.fail(start, "'struct' or 'package' is missing before " + shown(start.text));
      }
    }
    return std::move(types_);
  }

 private:
  std::string qualified(std::string_view name) const {
    if (package_.empty() || name.find('.') != std::string_view::npos) return std::string(name);
    return package_ + "." + std::string(name);
  }

  ParsedType parse_struct() {
    const Token name = lexer_.next();
    if (!is_name(name.text)) lexer_.fail(name, shown(name.text) + " is no name for a struct");
    ParsedType parsed;
    parsed.source = source_;
    parsed.line = name.line;
    parsed.type.name = qualified(name.text);
    lexer_.require("{");
    while (!lexer_.take("}")) {
      if (lexer_.take("const")) {
        parse_constants(parsed.type);
      } else {
        parse_members(parsed);
      }
    }
    return parsed;
  }

  Token new_name(const Type& type) {
    const Token name = lexer_.next();
    if (!is_name(name.text)) lexer_.fail(name, shown(name.text) + " is no name for a member");
    const auto same = [&](const auto& other) { return other.name == name.text; };
    if (std::any_of(type.members.begin(), type.members.end(), same) ||
        std::any_of(type.constants.begin(), type.constants.end(), same)) {
      lexer_.fail(name, shown(name.text) + " is declared twice");
    }
    return name;
  }

  void parse_constants(Type& type) {
    const Token word = lexer_.next();
    const Kind kind = kind_of(word.text);
    if (!is_integer(kind) && kind != Kind::float32 && kind != Kind::float64) {
      lexer_.fail(word, "a constant is an integer, float or double, not " + shown(word.text));
    }
    do {
      const Token name = new_name(type);
      lexer_.require("=");
      const Token value = lexer_.next();
      const std::string text(value.text);
      if (!is_constant_of(kind, text)) {
        lexer_.fail(value, shown(text) + " is no value of " + std::string(word.text));
      }
      type.constants.push_back({std::string(name.text), kind, text});
    } while (lexer_.take(","));
    lexer_.require(";");
  }

  void parse_members(ParsedType& parsed) {
    const Token word = lexer_.next();
    if (word.text == "struct" || word.text == "enum" || !is_qualified_name(word.text)) {
      lexer_.fail(word, shown(word.text) + " is no type of a member");
    }
    const Kind kind = kind_of(word.text);
    do {
      Member member;
      const Token name = new_name(parsed.type);
      member.name = name.text;
      member.kind = kind;
      member.type_name = kind == Kind::structure ? qualified(word.text) : std::string(word.text);
      while (lexer_.take("[")) member.dimensions.push_back(parse_dimension(parsed.type));
      parsed.type.members.push_back(std::move(member));
      parsed.member_lines.push_back(name.line);
    } while (lexer_.take(","));
    lexer_.require(";");
  }

  Dimension parse_dimension(Type& type) {
    const Token size = lexer_.next();
    Dimension dimension{.text = std::string(size.text)};
    lexer_.require("]");
    if (!is_name(size.text)) {
      const auto value = to_integer(dimension.text);
      if (!value || *value <= 0 || *value > std::numeric_limits<std::int32_t>::max()) {
        lexer_.fail(size, shown(size.text) +
                              " is no size of an array: a number from 1 to 2^31-1, "
                              "or an integer member declared before");
      }
      dimension.size = *value;
      return dimension;
    }
    const auto counter = std::find_if(type.members.begin(), type.members.end(),
                                      [&](const Member& m) { return m.name == size.text; });
    if (counter == type.members.end() || !counter->dimensions.empty() ||
        !is_integer(counter->kind)) {
      lexer_.fail(
          size, shown(size.text) + " sizes an array, but is no integer member declared before it");
    }
    if (counter->counter < 0) counter->counter = type.counters++;
    dimension.counter = counter->counter;
    return dimension;
  }

  std::string source_;
  Lexer lexer_;
  std::string package_;
  std::vector<ParsedType> types_;
};

}  // namespace

std::vector<ParsedType> parse_types(const TypeText& text) {
  return Parser(text).parse();
}

}  // namespace maploop::schema
