// Computes a first position from codes alone.
#pragma once

#include <string>
#include <vector>

#include "ppp/filter/parameters.h"
#include "ppp/filter/range_model.h"

namespace maploop::ppp {

struct SinglePoint {
  std::string failure;                // why there is no position; empty if there is one
  Eigen::Vector3d position{0, 0, 0};  // m, earth-fixed
  // This is the variance of the residuals relative to the expected one of the carriers' mean; 1
  // without redundancy.
  double residual_level = 1.0;
};

// Solves by weighted least squares. The systems' clocks differ by `clock_difference_sigma`. The
// largest residual beyond `start_outlier_sigmas` is left out, one satellite at a time, up to
// `start_outlier_share` of them; the solution fails if one beyond `start_largest_residual` remains.
// `near` is in m, earth-fixed.
SinglePoint solve_single_point(const std::vector<Measurement>& measured, GpsTime t,
                               const Eigen::Vector3d& near, const PppParameters& parameters,
                               RangeModel& model);

}  // namespace maploop::ppp
