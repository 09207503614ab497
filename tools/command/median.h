#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace maploop::tools {

// Of an even number of values: the mean of the two in the middle; of none: 0.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace maploop::tools
