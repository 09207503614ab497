#include "tools/evaluate/text_lines.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <utility>

#include "msgs/input_limits.h"
#include "msgs/trimmed.h"

namespace maploop::evaluation {
namespace {

// Returns the text up to the separator and removes both from `rest`.
std::string_view take(std::string_view& rest, std::string_view separators) {
  const std::string_view part = rest.substr(0, rest.find_first_of(separators));
  rest.remove_prefix(std::min(part.size() + 1, rest.size()));
  return part;
}

}  // namespace

TextLines::TextLines(std::string_view text, std::string name)
    : rest_(text), name_(std::move(name)) {
  constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
  if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
}

bool TextLines::next() {
  while (!rest_.empty()) {
    ++number_;
    const std::string_view line = take(rest_, "\n");
    if (trimmed(line, " \t\r").empty() || line.front() == '#') continue;
    line_ = trimmed(line, " \r");
    return true;
  }
  return false;
}

Cells TextLines::words(std::string_view separators) const {
  Cells all;
  for (std::string_view rest = line_; !rest.empty();)
    if (const std::string_view word = take(rest, separators); !word.empty()) all.push_back(word);
  return all;
}

void TextLines::fail(const std::string& what) const {
  throw std::runtime_error(name_ + ":" + std::to_string(std::max(number_, 1)) + ": " + what);
}

NamedColumns::NamedColumns(std::string_view text, std::string name)
    : lines_(text, std::move(name)) {
  if (!lines_.next()) fail("the file is empty");
  const auto separates = [&](char c) { return lines_.line().find(c) != std::string_view::npos; };
  separator_ = separates(',') ? ',' : separates(';') ? ';' : separates('\t') ? '\t' : ',';
  heading_ = split();
}

std::size_t NamedColumns::column(std::string_view names) const {
  const auto lower = [](unsigned char c) { return std::tolower(c); };
  const auto is_named = [&](std::string_view heading) {
    for (std::string_view rest = names; !rest.empty();)
      if (std::ranges::equal(take(rest, "|"), heading, {}, lower, lower)) return true;
    return false;
  };
  const auto found = std::find_if(heading_.begin(), heading_.end(), is_named);
  return found == heading_.end() ? none : static_cast<std::size_t>(found - heading_.begin());
}

std::size_t NamedColumns::column(std::string_view names, const std::string& otherwise) const {
  const std::size_t found = column(names);
  if (found == none) fail(otherwise);
  return found;
}

bool NamedColumns::next() {
  if (!lines_.next()) return false;
  cells_ = split();
  return true;
}

std::string_view NamedColumns::cell(std::size_t column) const {
  if (column == none) return {};
  if (column >= cells_.size()) fail("a column is missing");
  return cells_[column];
}

Cells NamedColumns::split() const {
  Cells cells;
  std::string_view rest = lines_.line();
  for (bool more = true; more;) {
    if (cells.size() == input_limits::columns)
      fail("more than " + std::to_string(input_limits::columns) + " columns");
    more = rest.find(separator_) != std::string_view::npos;
    cells.push_back(trimmed(take(rest, {&separator_, 1}), " \t\r\""));
  }
  return cells;
}

}  // namespace maploop::evaluation
