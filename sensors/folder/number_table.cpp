#include "sensors/folder/number_table.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sensors/number.h"
#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

// Returns the cells of a line. With blanks as the separator, several of them are one.
void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  const std::string_view ends = separator == ' ' ? " \t" : std::string_view(&separator, 1);
  while (true) {
    const std::size_t end = std::min(line.find_first_of(ends), line.size());
    cells.push_back(without_blanks(line.substr(0, end)));
    if (end == line.size()) return;
    line.remove_prefix(end + 1);
    if (separator == ' ') line = without_blanks(line);
  }
}

char separator_of(std::string_view line) {
  for (const char separator : {',', ';'})
    if (line.find(separator) != std::string_view::npos) return separator;
  return ' ';
}

// Returns nothing for what is not a number; NaN for what says so.
std::optional<double> number_of(std::string_view cell) {
  if (cell.empty() || cell == "nan" || cell == "NaN" || cell == "NAN") return not_a_number;
  if (cell.front() == '+') cell.remove_prefix(1);
  return parse_number<double>(cell);
}

std::filesystem::path kind_of_table(const std::filesystem::path& file) {
  return (file.extension() == ".gz" ? file.stem() : file).extension();
}

}  // namespace

bool is_pos_file(const std::filesystem::path& file) {
  return kind_of_table(file) == ".pos";
}

NumberTable::NumberTable(const std::filesystem::path& file, const NumberTableOptions& options)
    : file_(file) {
  std::string text = read_text(file);
  const auto kind = kind_of_table(file);
  try {
    if (kind == ".npy") {
      cells_ = parse_npy(text, options);
    } else if (kind == ".pos") {
      cells_ = parse_pos(text);
    }
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(file.string() + ": " + e.what());
  }
  if (kind == ".npy" || kind == ".pos") return;
  cells_.columns = options.columns;
  read_text_table(std::move(text), options);
}

void NumberTable::read_text_table(std::string text, const NumberTableOptions& options) {
  const auto fail = [&](std::size_t line, const std::string& why) {
    throw std::runtime_error(file_.string() + ":" + std::to_string(line) + ": " + why);
  };
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // byte order mark
  const std::vector<std::string_view> lines = split_lines(text);
  const bool headed = cells_.columns.empty();
  if (lines.empty()) fail(1, headed ? "has no heading" : "is empty");
  const auto row = std::ranges::find_if(
      lines, [headed](std::string_view line) { return headed || !line.starts_with('#'); });
  const char separator = separator_of(row == lines.end() ? lines[0] : *row);
  std::vector<std::string_view> cells;
  if (headed) {
    std::string_view heading = lines[0];
    while (heading.starts_with('#')) heading = without_blanks(heading.substr(1));
    split_cells(heading, separator, cells);
    for (std::string_view name : cells) {
      if (name.size() > 1 && name.front() == '"' && name.back() == '"')
        name = name.substr(1, name.size() - 2);
      cells_.columns.emplace_back(name);
    }
  }
  const auto found = std::ranges::find(cells_.columns, options.time);
  const auto exact = static_cast<std::size_t>(found - cells_.columns.begin());
  for (std::size_t i = headed ? 1 : 0; i < lines.size(); ++i) {
    if (lines[i].starts_with('#')) continue;
    split_cells(lines[i], separator, cells);
    if (cells.size() != cells_.columns.size()) {
      fail(i + 1, "has " + std::to_string(cells.size()) + " columns instead of " +
                      std::to_string(cells_.columns.size()));
    }
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const auto number = number_of(cells[k]);
      if (!number || (std::isnan(*number) && !options.missing)) {
        fail(i + 1,
             "column " + std::to_string(k + 1) + " is not a finite number: " + quoted(cells[k]));
      }
      cells_.values.push_back(*number);
      if (k == exact) cells_.whole.push_back(parse_number<std::int64_t>(cells[k]).value_or(none));
    }
    lines_.push_back(i + 1);
  }
}

bool NumberTable::has(std::string_view name) const {
  return std::ranges::find(cells_.columns, name) != cells_.columns.end();
}

std::size_t NumberTable::column(const std::string& name) const {
  const auto found = std::ranges::find(cells_.columns, name);
  if (found == cells_.columns.end()) {
    throw std::runtime_error(file_.string() + ": has no column '" + name + "'");
  }
  return static_cast<std::size_t>(found - cells_.columns.begin());
}

}  // namespace maploop::sensors
