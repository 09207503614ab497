#include "tools/report/error_plot.h"

#include <algorithm>
#include <cmath>

namespace maploop::report {

web::Plot error_plot(const ErrorSeries& s) {
  const bool known =
      std::any_of(s.error.begin(), s.error.end(), [](double e) { return std::isfinite(e); });
  web::Plot plot{(known ? "Error " : "Uncertainty ") + s.quantity, "s", s.unit};
  web::Band band{"3 sigma", s.seconds, {}, {}};
  for (const double sigma : s.sigma) {
    band.low.push_back(-sigmas * sigma);
    band.high.push_back(sigmas * sigma);
  }
  plot.bands.push_back(std::move(band));
  if (known) plot.lines.push_back({s.of + " minus truth", s.seconds, s.error});
  return plot;
}

}  // namespace maploop::report
