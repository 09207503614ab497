// These are the parameters of the vehicle and its sensors that the filter estimates on the way.
#pragma once

#include <array>
#include <string_view>

#include "estimators/fusion/filter_state.h"

namespace maploop::fusion {

// This is one estimated parameter. It is observed once the measurements have halved its
// uncertainty; before, the motion has not excited it, and the value is mostly what was given.
struct SelfCalibration {
  std::string_view name;
  std::string_view unit;
  double value = 0.0;
  double sigma = 0.0;
  double sigma_at_start = 0.0;

  bool observed() const { return sigma < 0.5 * sigma_at_start; }
};

using SelfCalibrations = std::array<SelfCalibration, 11>;

// `sigmas_at_start` are those of the states before any measurement, as they were given.
SelfCalibrations self_calibrations(const FilterState& state, const StateVector& sigmas_at_start);

}  // namespace maploop::fusion
