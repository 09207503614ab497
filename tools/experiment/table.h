// A table of an experiment, for the terminal and for a page.
#pragma once

#include <string>
#include <vector>

namespace maploop::experiments {

using Row = std::vector<std::string>;

struct Table {
  std::string title;
  Row heading;
  std::vector<Row> rows;
};

std::string number(double value, int digits);
std::string as_text(const Table& table);
std::string as_html(const Table& table);

}  // namespace maploop::experiments
