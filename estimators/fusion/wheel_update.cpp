#include "estimators/fusion/wheel_update.h"

#include "estimators/fusion/follow_innovation.h"
#include "estimators/fusion/gnss_update.h"

namespace maploop::fusion {

Innovation<1> wheel_innovation(const FilterState& state, const WheelSpeed& sample,
                               const FusionParameters& p) {
  using namespace index;
  // (17) of METHOD.md
  Innovation<1> innovation(sample.speed - state.x[speed],
                           sample.sigma * sample.sigma + p.min_wheel_sigma * p.min_wheel_sigma);
  innovation.H[speed] = 1.0;
  return innovation;
}

Outcome apply_wheel(FilterState& state, const WheelSpeed& sample, const FusionParameters& p) {
  const Innovation<1> innovation = wheel_innovation(state, sample, p);
  const auto correct = [&] {
    return apply_gated(state, innovation, p.speed_gate, Reason::wheel_gate, p.max_tilt);
  };
  follow(state, Witness::wheel_speed, innovation, p);
  state.wheel_check.add(sample);
  if (state.wheel_check.wrong) return refused(Reason::wheels_wrong);
  Outcome outcome = correct();
  if (outcome.refused() && ++state.wheel_gated_in_a_row % p.recover_after == 0 &&
      !held_by_fix(state, p)) {
    const double wrong = p.recovery_speed_sigma;
    state.P(index::speed, index::speed) += wrong * wrong;
    ++state.recoveries;
    outcome = correct();
  }
  if (!outcome.refused()) {
    state.wheel_gated_in_a_row = 0;
    state.wheel_stamp = sample.stamp;
  }
  return outcome;
}

}  // namespace maploop::fusion
