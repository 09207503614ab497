// Computes a first position from codes alone.
#pragma once

#include <array>
#include <string>

#include "ppp/filter/range_model.h"

namespace maploop::ppp {

struct SinglePoint {
  bool solved = false;
  std::string failure;
  Eigen::Vector3d position{0, 0, 0};  // m, earth-fixed
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::array<double, system_count> clocks{};  // m, of each system's clock
  std::array<bool, system_count> has_clock{};
  int used = 0, refused = 0;
  // This is the variance of the residuals relative to the expected one; 1 without redundancy.
  double residual_level = 1.0;
};

// Solves by weighted least squares. The largest residual beyond four standard deviations is left
// out, one satellite at a time, up to a quarter of them; the solution fails if one beyond ten
// remains. `near` is in m, earth-fixed, `elevation_mask` in rad and `code_sigma` in m. On success,
// the model has begun at the result.
SinglePoint solve_single_point(const std::vector<Measurement>& measurements, GpsTime t,
                               const Eigen::Vector3d& near, double elevation_mask,
                               double code_sigma, RangeModel& model);

}  // namespace maploop::ppp
