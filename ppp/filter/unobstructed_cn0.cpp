#include "ppp/filter/unobstructed_cn0.h"

#include <algorithm>

namespace maploop::ppp {

UnobstructedCn0::UnobstructedCn0(const PppParameters& parameters)
    : zenith_(parameters.full_cn0),
      drop_(parameters.full_cn0_drop),
      margin_(parameters.full_cn0_margin),
      step_(parameters.full_cn0_step),
      first_step_(parameters.full_cn0_first_step) {
  quartile_.fill(margin_);
}

double UnobstructedCn0::of_all(double sine) const {
  return zenith_ - drop_ * (1.0 - sine);
}

std::size_t UnobstructedCn0::band(double sine) {
  constexpr std::array<double, 3> bounds{0.342, 0.643, 0.866};  // 20, 40 and 60 degrees
  const auto above = std::upper_bound(bounds.begin(), bounds.end(), sine);
  return static_cast<std::size_t>(above - bounds.begin());
}

double UnobstructedCn0::of(double sine) const {
  if (zenith_ <= 0.0) return 0.0;
  return of_all(sine) + std::max(0.0, quartile_[band(sine)] - margin_);
}

// The steps up and down balance if a quarter of the strengths is above the estimate (Robbins and
// Monro, "A stochastic approximation method", Annals of Mathematical Statistics 22, 1951).
void UnobstructedCn0::add(double sine, double cn0) {
  constexpr double quartile_share = 0.75;  // of the strengths are below the upper quartile
  const std::size_t b = band(sine);
  const double step = std::max(step_, first_step_ / ++count_[b]);
  double& quartile = quartile_[b];
  quartile += step * (cn0 - of_all(sine) > quartile ? quartile_share : quartile_share - 1.0);
}

}  // namespace maploop::ppp
