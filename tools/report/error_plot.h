// An error against time with three of the standard deviations that are claimed for it.
#pragma once

#include <string>
#include <vector>

#include "tools/web/plot.h"

namespace maploop::report {

inline constexpr double sigmas = 3.0;

// Lists of one length; an error that is not finite is not known at that moment.
struct ErrorSeries {
  std::string quantity;  // such as east
  std::string unit;
  std::string of;  // whose error: fused, PPP
  std::vector<double> seconds, error, sigma;
};

// Without any known error only what is claimed.
web::Plot error_plot(const ErrorSeries& series);

}  // namespace maploop::report
