// Defines a scalar measurement, linearized about the state.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace maploop::ppp {

// The measurement is y = h dx + noise, where dx is the error of the state before the update.
struct LinearRow {
  double y = 0.0, variance = 0.0;
  int count = 0;
  std::array<int, 16> indices{};
  std::array<double, 16> h{};

  void add(int index, double value) {
    indices[static_cast<std::size_t>(count)] = index;
    h[static_cast<std::size_t>(count++)] = value;
  }
  // Returns the residual of y after the correction dx.
  double residual_after(const Eigen::VectorXd& dx) const {
    double rest = y;
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) rest -= h[k] * dx[indices[k]];
    return rest;
  }
};

}  // namespace maploop::ppp
