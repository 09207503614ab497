// The middle of some values; of an even number the upper one of the two.
#pragma once

#include <algorithm>
#include <vector>

namespace maploop::ppp {

// There is at least one; their order changes.
inline double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace maploop::ppp
