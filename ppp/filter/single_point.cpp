#include "ppp/filter/single_point.h"

#include <Eigen/Dense>
#include <cmath>

namespace maploop::ppp {

SinglePoint solve_single_point(const std::vector<Measurement>& measurements, GpsTime t,
                               const Eigen::Vector3d& near, double elevation_mask,
                               double code_sigma, RangeModel& model) {
  constexpr int columns = 3 + system_count;
  SinglePoint result;
  result.position = near;
  std::vector<bool> left_out(measurements.size(), false);
  for (int rejections = 0;; ++rejections) {
    Eigen::Matrix<double, columns, 1> dx;
    Eigen::Matrix<double, columns, columns> normal;
    double worst = 0.0, sum = 0.0;
    int clocks = 0;
    std::size_t worst_at = 0;
    bool settled = false;
    for (int iteration = 0; iteration < 12 && !settled; ++iteration) {
      // Without a position near the earth's surface there is no local frame: the first iterations
      // do without models.
      const bool on_earth = result.position.norm() > 6.2e6;
      model.begin(t, on_earth ? result.position : Eigen::Vector3d(6378137.0, 0, 0));
      normal.setZero();
      Eigen::Matrix<double, columns, 1> right = Eigen::Matrix<double, columns, 1>::Zero();
      result.has_clock.fill(false);
      result.used = 0;
      worst = sum = 0.0;
      for (std::size_t i = 0; i < measurements.size(); ++i) {
        if (left_out[i]) continue;
        const Measurement& m = measurements[i];
        double wind_up_cycles = 0.0;
        auto p = model.predict(m, wind_up_cycles);
        if (!p) continue;
        if (!on_earth) {
          const Eigen::Vector3d d = p->satellite.position - result.position;
          p->range = d.norm() - speed_of_light * p->satellite.clock;
          p->to_satellite = d.normalized();
          p->elevation = 1.0;
        } else if (p->elevation < elevation_mask) {
          continue;
        }
        const auto system = static_cast<std::size_t>(m.satellite.system);
        const double sine = std::sin(p->elevation);
        const double noise = m.noise_factor() * code_sigma / sine;
        const double variance = noise * noise + p->satellite.sigma * p->satellite.sigma +
                                p->ionosphere.sigma * p->ionosphere.sigma + 0.01;
        const double y = m.code() - p->range - p->ionosphere.value - result.clocks[system];
        Eigen::Matrix<double, columns, 1> h = Eigen::Matrix<double, columns, 1>::Zero();
        h.head<3>() = -p->to_satellite;
        h[3 + static_cast<int>(system)] = 1.0;
        normal += h * h.transpose() / variance;
        right += h * (y / variance);
        result.has_clock[system] = true;
        ++result.used;
        sum += y * y / variance;
        if (std::abs(y) / std::sqrt(variance) > worst) {
          worst = std::abs(y) / std::sqrt(variance);
          worst_at = i;
        }
      }
      clocks = 0;
      for (std::size_t s = 0; s < result.has_clock.size(); ++s) {
        const int at = 3 + static_cast<int>(s);
        if (result.has_clock[s]) {
          ++clocks;
        } else {
          normal(at, at) = 1.0;
        }
      }
      if (result.used < 3 + clocks) {
        result.failure = std::to_string(result.used) +
                         " satellites with orbit, clock and code above " + "the mask, and " +
                         std::to_string(3 + clocks) + " are needed";
        return result;
      }
      dx = normal.ldlt().solve(right);
      if (!dx.allFinite()) break;
      result.position += dx.head<3>();
      for (std::size_t s = 0; s < result.clocks.size(); ++s) {
        result.clocks[s] += dx[3 + static_cast<int>(s)];
      }
      settled = dx.head<3>().norm() < 1e-3;
    }
    const double height = result.position.norm() - 6.37e6;
    if (!settled || height < -1e5 || height > 1e6) {
      result.failure = "the position by code does not settle";
      return result;
    }
    if (worst > 4.0 && rejections < static_cast<int>(measurements.size()) / 4) {
      left_out[worst_at] = true;
      ++result.refused;
      continue;
    }
    if (worst > 10.0) {
      result.failure = "codes disagree beyond a quarter of the satellites";
      return result;
    }
    if (const int spare = result.used - 3 - clocks; spare > 0) result.residual_level = sum / spare;
    result.covariance = normal.inverse().topLeftCorner<3, 3>();
    result.solved = true;
    model.begin(t, result.position);
    return result;
  }
}

}  // namespace maploop::ppp
