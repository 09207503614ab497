#include "tools/experiment/table.h"

#include <fmt/format.h>
#include <algorithm>

namespace maploop::experiments {

std::string number(double value, int digits) {
  return fmt::format("{:.{}f}", value, digits);
}

std::string as_text(const Table& table) {
  std::vector<std::size_t> width(table.heading.size(), 0);
  const auto measure = [&](const Row& row) {
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  };
  measure(table.heading);
  for (const Row& row : table.rows) measure(row);
  std::string text = "\n" + table.title + "\n";
  const auto line = [&](const Row& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += std::string(width[i] - row[i].size() + 2, ' ') + row[i];
    }
    text += '\n';
  };
  line(table.heading);
  for (const Row& row : table.rows) line(row);
  return text;
}

}  // namespace maploop::experiments
