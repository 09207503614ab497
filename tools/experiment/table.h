// A table of an experiment, for the terminal.
#pragma once

#include <string>
#include <utility>
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

// Groups values by their cells and keeps the order in which the cells first came.
template <class Value>
class Groups {
 public:
  Value& operator[](const Row& key) {
    for (auto& [known, value] : groups_)
      if (known == key) return value;
    return groups_.emplace_back(key, Value{}).second;
  }
  auto begin() const { return groups_.begin(); }
  auto end() const { return groups_.end(); }

 private:
  std::vector<std::pair<Row, Value>> groups_;
};

}  // namespace maploop::experiments
