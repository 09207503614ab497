// These are the properties of the vehicle and its sensors that the filter estimates on the way, and
// what it remembers of them from an earlier drive.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "estimators/fusion/filter_state.h"
#include "msgs/time.h"

namespace maploop::fusion {

// This is one estimated property. It is observed once the measurements have halved its uncertainty;
// before, the motion has not excited it, and the value is mostly what was given.
struct CalibratedProperty {
  std::string_view key;         // its name in files
  std::string_view name;        // what it is, in words
  std::string_view unit;        // of the numbers below, such as "deg" or "%"
  double value = 0.0;           // estimated by now
  double sigma = 0.0;           // standard deviation by now
  double sigma_at_start = 0.0;  // standard deviation before any measurement

  // Returns whether the measurements have halved the uncertainty; false before the start.
  bool observed() const { return sigma > 0.0 && sigma < 0.5 * sigma_at_start; }
};

// Number of estimated properties.
inline constexpr std::size_t calibrated_count = 19;
// Holds all properties, always in the same order.
using SelfCalibrations = std::array<CalibratedProperty, calibrated_count>;

// `sigmas_at_start` are those of the states before any measurement, as they were given.
SelfCalibrations self_calibrations(const FilterState& state, const StateVector& sigmas_at_start);

// Holds what an earlier drive of the same car has estimated, in the order and the units of
// SelfCalibrations. A sigma of 0 means that the property is not known.
struct RememberedCalibration {
  Time at{};                                     // when it was estimated
  std::array<double, calibrated_count> value{};  // each in its unit
  std::array<double, calibrated_count> sigma{};  // each in its unit; 0: not known
};

template <class Archive>
void archive(Archive& ar, RememberedCalibration& r) {
  ar(r.at, r.value, r.sigma);
}

// Returns the standard deviation, in the unit of SelfCalibrations, of a remembered property after
// `age`. A drive ends with sigmas that hold for that drive only: load, tyres, temperature and
// mounts change, and a bias is another one when its sensor is switched on again. So a share of the
// sigma at the start is added, which grows with time until nothing is left of what was remembered.
double remembered_sigma(std::size_t property, double sigma, double sigma_at_start, Duration age);

// Corrects a first state by the remembered properties, (35) of METHOD.md, as by a measurement of
// each.
void recall(FilterState& state, const RememberedCalibration& remembered,
            const StateVector& sigmas_at_start);

}  // namespace maploop::fusion
