// Computes the error of the position that lasts for many epochs: that of orbits, clocks and
// ionosphere.
#pragma once

#include <optional>
#include <vector>

#include "ppp/filter/satellite_tracker.h"

namespace maploop::ppp {

struct LastingError {
  Eigen::Vector2d variance = Eigen::Vector2d::Zero();  // m^2, of the position, east and north
  // An ionosphere without a model, as large as its standard deviation, moves the position by this
  // vector; m, earth-fixed.
  Eigen::Vector3d unmodelled_ionosphere_shift = Eigen::Vector3d::Zero();

  template <class Archive>
  void archive(Archive& ar) {
    ar(variance, unmodelled_ionosphere_shift);
  }
};

// Returns the variance of a range due to errors of orbit, clock and ionosphere, m^2.
inline double lasting_variance(const PredictedRange& p) {
  return p.satellite.sigma * p.satellite.sigma + p.ionosphere.sigma * p.ionosphere.sigma;
}

// Computes it by least squares for position and clock from the ranges' lasting errors alone.
// Returns nothing without redundancy; the error of the last epoch is then the best guess.
std::optional<LastingError> lasting_error_of(const std::vector<Tracked>& tracked,
                                             const RangeModel& model, const FilterState& state,
                                             const PppParameters& parameters);

// Adds the part of the lasting error that the map has revealed to a solution's position and
// covariance.
void add_lasting_error(const FilterState& state, const Eigen::Matrix3d& R_enu_ecef,
                       PppSolution& solution);

}  // namespace maploop::ppp
