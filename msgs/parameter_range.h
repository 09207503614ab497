// This file checks the ranges of parameters and reports values outside of them.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace maploop {

struct ParameterRange {
  std::string_view name;
  double least = 0.0;
  double most = 0.0;
  std::string_view unit = {};
};

// Returns if the value is in its range, ends included. Throws std::invalid_argument that names
// table, key, value and range if it is not, if it is not a number, or if the key has no range.
inline void check_range(std::string_view table, std::span<const ParameterRange> ranges,
                        std::string_view key, double value) {
  const auto number = [](double v) {
    std::string text = std::to_string(v);  // with six digits after the point
    if (text.find('.') == std::string::npos) return text;
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
  };
  const std::string name = "[" + std::string(table) + "] " + std::string(key);
  for (const ParameterRange& range : ranges) {
    if (range.name != key) continue;
    if (value >= range.least && value <= range.most) return;
    const std::string unit = range.unit.empty() ? "" : " " + std::string(range.unit);
    throw std::invalid_argument(name + " is " + number(value) + "; it must be " +
                                number(range.least) + " to " + number(range.most) + unit);
  }
  throw std::invalid_argument(name + " has no range");
}

}  // namespace maploop
