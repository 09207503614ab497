// Plots an error against time with three of its estimated standard deviations.
#pragma once

#include <string>
#include <vector>

#include "tools/web/plot.h"

namespace maploop::report {

inline constexpr double sigmas = 3.0;

// All lists have the same length; an error that is not finite is unknown at that time.
struct ErrorSeries {
  std::string quantity;  // such as east
  std::string unit;
  std::string of;  // source of the error: fused, PPP
  std::vector<double> seconds, error, sigma;
};

// Without any known error it plots only the standard deviations.
web::Plot error_plot(const ErrorSeries& series);

}  // namespace maploop::report
