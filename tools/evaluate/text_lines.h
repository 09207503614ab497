// Walks through the lines of text files and the cells in them. Errors name file and line.
#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace maploop::evaluation {

using Cells = std::vector<std::string_view>;

// Returns the number that all of the text is, or nothing.
template <class Number>
std::optional<Number> number_of(std::string_view text) {
  Number value{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return {};
  return value;
}

class TextLines {
 public:
  // Holds views into `text`, which must outlive this. `name` is the file's, for errors.
  TextLines(std::string_view text, std::string name);

  // Goes to the next line that is neither blank nor a comment (#). Returns false at the end.
  bool next();
  std::string_view line() const { return line_; }  // without its line end and blanks around it
  int number() const { return number_; }           // of the line in the file, from 1

  // Returns the words between any of the separators.
  Cells words(std::string_view separators = " \t,") const;

  // Throws std::runtime_error with the text "NAME:LINE: what".
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string_view rest_, line_;
  std::string name_;
  int number_ = 0;
};

// Reads a table whose first line names the columns; cells are separated by comma, semicolon or tab.
// All functions fail as TextLines::fail().
class NamedColumns {
 public:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  // Fails if there is no heading.
  NamedColumns(std::string_view text, std::string name);

  // Returns the first column that has one of the names ("lat|latitude"; case does not matter), or
  // `none`.
  std::size_t column(std::string_view names) const;
  // The same; fails with `otherwise` if there is none.
  std::size_t column(std::string_view names, const std::string& otherwise) const;

  bool next();
  // Returns a cell without blanks and quotes around it; it is empty for the column `none`.
  std::string_view cell(std::size_t column) const;
  template <class Number>
  Number number(std::size_t column) const {
    const auto value = number_of<Number>(cell(column));
    if (!value) lines_.fail("'" + std::string(cell(column)) + "' is not a number");
    return *value;
  }
  [[noreturn]] void fail(const std::string& what) const { lines_.fail(what); }

 private:
  Cells split() const;

  TextLines lines_;
  char separator_ = ',';
  Cells heading_, cells_;
};

}  // namespace maploop::evaluation
