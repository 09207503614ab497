// This file measures how deep the keys of a TOML text nest, before the text is parsed.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace maploop::runtime {

// Each part of a dotted key is a table inside the previous one, and libtomlplusplus traverses
// tables by recursion. (It limits arrays and inline tables itself.)
class KeyDepth {
 public:
  explicit KeyDepth(std::string_view text) : text_(text) {}

  // Returns the line (from 1) of the first key with more than `most` parts; 0 if there is none.
  std::size_t first_deeper_than(std::size_t most) {
    std::size_t dots = 0;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string(c);
      } else if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else {
        if (c == '.') {
          if (++dots >= most) return line();
        } else if (!is_of_key(c)) {
          dots = 0;
        }
        ++at_;
      }
    }
    return 0;
  }

 private:
  static bool is_of_key(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == ' ' || c == '\t';
  }

  // Skips a string of one line, or of several between triple quotes; backslashes escape inside
  // double quotes.
  void skip_string(char quote) {
    const bool many = text_.substr(at_, 3) == std::string(3, quote);
    at_ += many ? 3 : 1;
    while (at_ < text_.size()) {
      if (quote == '"' && text_[at_] == '\\') {
        at_ += 2;
      } else if (many ? text_.substr(at_, 3) == std::string(3, quote) : text_[at_] == quote) {
        at_ += many ? 3 : 1;
        while (many && at_ < text_.size() && text_[at_] == quote) ++at_;  // at most two
        return;
      } else if (!many && text_[at_] == '\n') {
        return;  // reported by the parser
      } else {
        ++at_;
      }
    }
  }

  std::size_t line() const {
    const auto begin = text_.begin();
    return 1 + static_cast<std::size_t>(
                   std::count(begin, begin + static_cast<std::ptrdiff_t>(at_), '\n'));
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace maploop::runtime
