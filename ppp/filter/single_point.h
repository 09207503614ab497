// A position by code alone, from nothing.
#pragma once

#include <array>
#include <string>

#include "ppp/filter/range_model.h"

namespace maploop::ppp {

struct SinglePoint {
  bool solved = false;
  std::string why_not;
  Eigen::Vector3d position{0, 0, 0};  // m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::array<double, system_count> clocks{};  // m, of each system
  std::array<bool, system_count> has_clock{};
  int used = 0, refused = 0;
  // Variance of the residuals against what is expected; 1 where there are none to spare.
  double residual_level = 1.0;
};

// Weighted least squares; the largest residual beyond four standard deviations is left out, one
// after the other. At most a quarter of the satellites. The model is begun anew at the result.
SinglePoint solve_single_point(const std::vector<Measurement>& measurements, GpsTime t,
                               const Eigen::Vector3d& near, double elevation_mask,
                               double code_sigma, RangeModel& model);

}  // namespace maploop::ppp
