#include "sensors/replay/csv_table.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>

#include "sensors/replay/files.h"

namespace maploop::sensors {

CsvTable::CsvTable(const std::filesystem::path& file) : file_(file) {
  const auto fail = [&](std::size_t line, const std::string& why) {
    throw std::runtime_error(file.string() + ":" + std::to_string(line) + ": " + why);
  };
  std::string text = read_text(file);
  const std::size_t heading = std::min(text.find('\n'), text.size());
  std::replace(text.begin() + static_cast<std::ptrdiff_t>(heading), text.end(), ',', ' ');
  const std::vector<std::string_view> lines = split_lines(text);
  if (lines.empty()) fail(1, "has no heading");
  for (std::string_view rest = lines[0]; !rest.empty();) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    columns_.emplace_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  for (std::size_t i = 1; i < lines.size(); ++i) {
    try {
      const std::vector<double> numbers = parse_numbers(lines[i]);
      if (numbers.size() != columns_.size()) {
        fail(i + 1, "has " + std::to_string(numbers.size()) + " columns instead of " +
                        std::to_string(columns_.size()));
      }
      cells_.insert(cells_.end(), numbers.begin(), numbers.end());
    } catch (const std::invalid_argument& e) {
      fail(i + 1, e.what());
    }
  }
}

std::size_t CsvTable::column(const std::string& name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found == columns_.end()) {
    throw std::runtime_error(file_.string() + ": has no column '" + name + "'");
  }
  return static_cast<std::size_t>(found - columns_.begin());
}

}  // namespace maploop::sensors
