#include "estimators/fusion/wheel_update.h"

#include "estimators/fusion/gnss_update.h"

namespace maploop::fusion {

Innovation<1> wheel_innovation(const FilterState& state, const WheelSpeed& sample,
                               const FusionParameters& p) {
  using namespace index;
  Innovation<1> innovation;
  innovation.residual << sample.speed - state.x[speed];  // (17) of METHOD.md
  innovation.H.setZero();
  innovation.H[speed] = 1.0;
  innovation.R << sample.sigma * sample.sigma + p.min_wheel_sigma * p.min_wheel_sigma;
  return innovation;
}

Outcome apply_wheel(FilterState& state, const WheelSpeed& sample, const FusionParameters& p) {
  const auto correct = [&] {
    return apply_gated(state, wheel_innovation(state, sample, p), p.speed_gate, Reason::wheel_gate);
  };
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
