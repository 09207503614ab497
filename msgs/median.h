// Computes the median; of an even number of values it is the upper one of the middle two.
#pragma once

#include <algorithm>
#include <span>

namespace maploop {

// Precondition: there is at least one value. The order of the values changes.
inline double median(std::span<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace maploop
