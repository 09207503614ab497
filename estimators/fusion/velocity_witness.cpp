#include "estimators/fusion/velocity_witness.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/turn_round.h"

namespace maploop::fusion {
namespace {

constexpr Duration just_now = std::chrono::milliseconds(500);

constexpr double creep = 1.0;         // m/s, which fixes of a standing vehicle may say
constexpr double creep_sigmas = 4.0;  // and so many of their own standard deviations
constexpr Duration carried_doubt = std::chrono::seconds(3), denial = std::chrono::seconds(5);

constexpr double fast = 3.0;       // m/s, at which the course of a fix is certain
constexpr double opposite = -0.9;  // cosine between two courses
constexpr Duration front_doubted = std::chrono::seconds(2);

double sigma_of(const GnssFix& fix) {
  return std::sqrt(fix.velocity_covariance.diagonal().head<2>().maxCoeff());
}

void judge_wheels(FilterState& state, const GnssFix& fix, const FusionParameters& p) {
  if (!state.wheel_check.compare(fix, state.x[index::speed_scale])) return;
  state.P(index::speed, index::speed) += p.recovery_speed_sigma * p.recovery_speed_sigma;
  state.refused_fixes = {};
  state.velocity_gated_in_a_row = 0;
  ++state.recoveries;
}

void judge_standstill(FilterState& state, const GnssFix& fix) {
  Stillness& s = state.stillness;
  const Time t = fix.velocity_stamp;
  if (!(fix.velocity_enu.head<2>().norm() > creep + creep_sigmas * sigma_of(fix))) {
    s.carried_since = s.denied_until = {};
    return;
  }
  const bool stands = std::max(state.zero_velocity_stamp + just_now, s.denied_until) > t;
  if (!stands) s.carried_since = {};
  if (stands && s.carried_since == Time{}) s.carried_since = t;
  if (!stands || t - s.carried_since < carried_doubt) return;
  if (s.denied_until < t) {
    state.P(index::speed, index::speed) += fix.velocity_enu.squaredNorm();
    state.refused_fixes = {};
  }
  s.denied_until = t + denial;
}

// Returns whether the fix goes where the rear of the vehicle is that drives forward, or the other
// way round.
bool contrary(const FilterState& state, const GnssFix& fix) {
  const Eigen::Vector2d by_fix = fix.velocity_enu.head<2>();
  const Eigen::Vector2d by_state =
      state.ground_speed() * direction(state.x[index::azimuth], state.climb()).head<2>();
  return std::min(by_fix.norm(), by_state.norm()) > fast &&
         by_fix.dot(by_state) < opposite * by_fix.norm() * by_state.norm();
}

void judge_front(FilterState& state, const GnssFix& fix, const FusionParameters& p) {
  using namespace index;
  if (!(sigma_of(fix) < worst_judge)) return;
  const Time t = fix.velocity_stamp;
  const bool sign_known =
      std::max(state.odometry_stamp, state.wheel_stamp) > t - from_seconds(p.fix_hold);
  const bool rear_first = !sign_known && state.ground_speed() < -fastest_reverse;
  const bool against = contrary(state, fix);
  if ((!rear_first && !against) || state.forward_stamp == Time{}) state.forward_stamp = t;
  if (t - state.forward_stamp <= front_doubted) return;
  turn_round(state);
  if (against) {  // the speed was right
    for (const int i : {speed, distance}) {
      state.x[i] = -state.x[i];
      state.P.row(i) *= -1.0;
      state.P.col(i) *= -1.0;
    }
  }
  state.forward_stamp = t;
  state.refused_fixes = {};
  ++state.recoveries;
}

}  // namespace

void judge_by_velocity(FilterState& state, const GnssFix& fix, const FusionParameters& p) {
  judge_wheels(state, fix, p);
  judge_standstill(state, fix);
  judge_front(state, fix, p);
}

}  // namespace maploop::fusion
