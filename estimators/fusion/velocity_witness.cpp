#include "estimators/fusion/velocity_witness.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "estimators/fusion/filter_state.h"
#include "estimators/fusion/turn_round.h"

namespace maploop::fusion {
namespace {

constexpr Duration just_now = std::chrono::milliseconds(500);
constexpr double worst_judge = 0.6;  // m/s, 1 sigma of a velocity that can judge

constexpr double creep = 1.0;          // m/s, which fixes of a standing vehicle may say
constexpr double creep_sigmas = 4.0;   // and so many of their own standard deviations
constexpr double carried_doubt = 3.0;  // s
constexpr Duration denial = std::chrono::seconds(5);

constexpr double fast = 3.0;           // m/s, at which the course of a fix is certain
constexpr double opposite = -0.9;      // cosine between two courses
constexpr double front_doubted = 2.0;  // s

void judge_wheels(FilterState& state, const GnssFix& fix, const FixStep& step,
                  const FusionParameters& p) {
  if (!state.wheel_check.compare(fix, step, state.x[index::speed_scale])) return;
  state.P(index::speed, index::speed) += p.recovery_speed_sigma * p.recovery_speed_sigma;
  state.refused_fixes = {};
  state.velocity_gated_in_a_row = 0;
  ++state.recoveries;
}

void judge_standstill(FilterState& state, const GnssFix& fix, const FixStep& step) {
  Stillness& s = state.stillness;
  const Time t = fix.velocity_stamp;
  const double moves = fix.velocity_enu.head<2>().norm();
  if (step.interval == 0.0 || moves < creep + creep_sigmas * velocity_sigma_of(fix)) {
    s.carried = {};
    s.denied_until = {};
    return;
  }
  if (std::max(state.zero_velocity_stamp + just_now, s.denied_until) < t) {
    s.carried = {};
    return;
  }
  s.carried.add(step);
  if (!s.carried.shows(carried_doubt, position_sigma_of(fix))) return;
  if (s.denied_until < t) {
    state.P(index::speed, index::speed) += moves * moves;
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

void judge_front(FilterState& state, const GnssFix& fix, const FixStep& step,
                 const FusionParameters& p) {
  const Time recent = fix.velocity_stamp - from_seconds(p.fix_hold);
  const bool sign_known =
      state.wheel_stamp > recent || (p.use_odometry_speed && state.odometry_stamp > recent);
  const bool rear_first = !sign_known && state.ground_speed() < -fastest_reverse;
  const bool against = contrary(state, fix);
  if (step.interval == 0.0 || (!rear_first && !against)) {
    state.front_doubt = {};
    state.front_known |= !against && state.ground_speed() > fastest_reverse;
    return;
  }
  state.front_doubt.add(step);
  if (state.front_known || !state.front_doubt.shows(front_doubted, position_sigma_of(fix))) return;
  against ? turn_heading(state) : turn_round(state);
  state.front_doubt = {};
  state.refused_fixes = {};
  ++state.recoveries;
}

}  // namespace

void judge_by_velocity(FilterState& state, const GnssFix& fix, const LocalFrame& frame,
                       const FusionParameters& p) {
  if (fix.increment || !(velocity_sigma_of(fix) < worst_judge)) return;
  const FixStep step = state.fix_before.step_to(fix, frame);
  judge_wheels(state, fix, step, p);
  judge_standstill(state, fix, step);
  judge_front(state, fix, step, p);
}

}  // namespace maploop::fusion
