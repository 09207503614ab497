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
constexpr double longer_than_slip = 4.0;  // s

}  // namespace

bool WheelCheck::compare(const GnssFix& fix, const FixStep& step, double scale) {
  if (step.interval == 0.0) {
    opposed = {};
    return false;
  }
  const double by_fix = fix.velocity_enu.head<2>().norm();
  double by_wheels = speed / (1.0 + scale);
  const double fast = std::max(by_fix, std::abs(by_wheels));
  if (std::chrono::abs(fix.velocity_stamp - stamp) > same_time || fast < slowest) return false;
  // A fix does not tell which way the vehicle faces.
  if (by_fix < fastest_reverse) by_wheels = std::abs(by_wheels);
  const bool apart = std::abs(by_fix - by_wheels) >
                     std::max(least_error, least_share * fast) + sigmas * velocity_sigma_of(fix);
  if (apart == wrong) {
    opposed = {};
    return false;
  }
  opposed.add(step);
  if (!opposed.shows(longer_than_slip, position_sigma_of(fix))) return false;
  opposed = {};
  wrong = !wrong;
  return wrong;
}

}  // namespace maploop::fusion
