// This file finds the unit of the times of a scan's points.
#pragma once

#include <optional>

namespace maploop::sensors {

// Returns the unit in s (1, 1e-3, 1e-6 or 1e-9) in which a scan whose times span `span` takes 0.5
// to 500 ms; nothing if there is none. Each unit is a thousandth of the previous one, as is the
// shortest scan of the longest, so that no two of them fit.
inline std::optional<double> time_unit(double span) {
  constexpr double shortest = 0.0005, longest = 0.5;  // s
  double unit = 1.0;
  while (unit > 2e-9 && span * unit > longest) unit *= 1e-3;
  if (!(span * unit <= longest && span * unit >= shortest)) return std::nullopt;
  return unit;
}

}  // namespace maploop::sensors
