// Computes quantiles: values of which a share is smaller.
#pragma once

#include <algorithm>
#include <span>

namespace maploop {

// Precondition: there is at least one value, and the share is in [0, 1). The order of the values
// changes.
inline double quantile(std::span<double> values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

// The same of a half: of an even number of values it is the upper one of the middle two.
inline double median(std::span<double> values) {
  return quantile(values, 0.5);
}

}  // namespace maploop
