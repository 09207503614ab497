#include "estimators/fusion/wheel_check.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace maploop::fusion {
namespace {

constexpr Duration same_time = std::chrono::milliseconds(200);
constexpr double slowest = 3.0;      // m/s, below which a wrong unit shows too little
constexpr double least_error = 1.5;  // m/s, and as a share of the speed: more than tyres slip
constexpr double least_share = 0.25;
constexpr double sigmas = 3.0;
constexpr double longest_step = 1.0;  // s, that one fix may count
constexpr double enough = 4.0;        // s, longer than tyres slip

}  // namespace

bool WheelCheck::compare(const GnssFix& fix, double scale) {
  const double sigma = std::sqrt(fix.velocity_covariance.diagonal().head<2>().maxCoeff());
  const double by_fix = fix.velocity_enu.head<2>().norm();
  double by_wheels = speed / (1.0 + scale);
  const double fast = std::max(by_fix, std::abs(by_wheels));
  if (std::chrono::abs(fix.velocity_stamp - stamp) > same_time || !(sigma < worst_judge) ||
      fast < slowest || fix.velocity_stamp <= compared) {
    return false;
  }
  // A fix does not tell which way the vehicle faces.
  if (by_fix < fastest_reverse) by_wheels = std::abs(by_wheels);
  const bool apart =
      std::abs(by_fix - by_wheels) > std::max(least_error, least_share * fast) + sigmas * sigma;
  const double step = std::min(longest_step, to_seconds(fix.velocity_stamp - compared));
  compared = fix.velocity_stamp;
  opposed = apart == wrong ? 0.0 : opposed + step;
  if (opposed < enough) return false;
  opposed = 0.0;
  wrong = !wrong;
  return wrong;
}

}  // namespace maploop::fusion
