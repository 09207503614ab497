#include "estimators/lidar/disparity_from_depth.h"

#include <algorithm>
#include <cmath>

namespace maploop::lidar {

using Eigen::Vector3d;

DisparityFromDepth::DisparityFromDepth(const StereoCalibration& camera,
                                       const DisparityParameters& parameters)
    : camera_(camera),
      parameters_(parameters),
      T_cam_body_(camera.T_body_cam.inverse()),
      columns_(static_cast<int>(camera.width / parameters.radius) + 1),
      rows_(static_cast<int>(camera.height / parameters.radius) + 1),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

void DisparityFromDepth::project(const PreparedScan& scan) {
  seen_.clear();
  for (auto& cell : cells_) cell.clear();
  for (const SurfacePoint& surface : scan.points) {
    const Vector3d p = T_cam_body_ * surface.position.cast<double>();
    if (p.z() < parameters_.min_depth || p.z() > 1.2 * parameters_.max_depth) continue;
    const double u = camera_.cx + camera_.fx * p.x() / p.z();
    const double v = camera_.cy + camera_.fy * p.y() / p.z();
    if (!(u >= 0.0 && v >= 0.0 && u < camera_.width && v < camera_.height)) continue;
    const int cell = static_cast<int>(v / parameters_.radius) * columns_ +
                     static_cast<int>(u / parameters_.radius);
    cells_[static_cast<std::size_t>(cell)].push_back(static_cast<std::int32_t>(seen_.size()));
    seen_.push_back({{u, v}, p, T_cam_body_.linear() * surface.normal.cast<double>()});
  }
}

// Where the surfaces beside the feature agree.
std::optional<double> DisparityFromDepth::depth(const DisparityFeature& feature) const {
  const Vector3d ray((feature.u - camera_.cx) / camera_.fx, (feature.v - camera_.cy) / camera_.fy,
                     1.0);
  const double length = ray.norm();
  double sum = 0.0, weights = 0.0, nearest = 1e9, furthest = 0.0;
  int count = 0;
  const int column = static_cast<int>(feature.u / parameters_.radius);
  const int row = static_cast<int>(feature.v / parameters_.radius);
  for (int y = std::max(0, row - 1); y <= std::min(rows_ - 1, row + 1); ++y) {
    for (int x = std::max(0, column - 1); x <= std::min(columns_ - 1, column + 1); ++x) {
      for (const std::int32_t i : cells_[static_cast<std::size_t>(y * columns_ + x)]) {
        const Seen& seen = seen_[static_cast<std::size_t>(i)];
        const double away = (seen.image - Eigen::Vector2d(feature.u, feature.v)).norm();
        if (away > parameters_.radius) continue;
        // The surface itself counts for edges, even where it is seen too slantwise to be used.
        nearest = std::min(nearest, seen.point.z());
        furthest = std::max(furthest, seen.point.z());
        const double across = seen.normal.dot(ray);
        if (std::abs(across) < parameters_.max_angle_cosine * length) continue;
        const double z = seen.normal.dot(seen.point) / across;
        if (std::abs(z - seen.point.z()) > parameters_.max_spread * seen.point.z()) continue;
        const double weight = 1.0 / (4.0 + away * away);
        sum += weight * z;
        weights += weight;
        ++count;
      }
    }
  }
  if (count < parameters_.min_surfaces) return std::nullopt;
  const double z = sum / weights;
  if (furthest - nearest > 2.0 * parameters_.max_spread * z) return std::nullopt;
  if (z < parameters_.min_depth || z > parameters_.max_depth) return std::nullopt;
  return z;
}

// From the weighted median on, with Geman-McClure weights at three standard deviations of what the
// residuals spread by.
DisparityMeasurement DisparityFromDepth::robust_mean() {
  const auto middle = residuals_.begin() + static_cast<std::ptrdiff_t>(residuals_.size() / 2);
  const auto by_value = [](const Residual& a, const Residual& b) { return a.value < b.value; };
  std::nth_element(residuals_.begin(), middle, residuals_.end(), by_value);
  DisparityMeasurement result{middle->value, 0.0, 0};
  double spread = 0.0;  // whitened, 1 where the parameters are right
  for (int iteration = 0; iteration < 10; ++iteration) {
    double sum = 0.0, information = 0.0, square = 0.0, weights = 0.0;
    result.features = 0;
    const double limit = 9.0 * std::max(1.0, spread);
    for (const Residual& residual : residuals_) {
      const double d = residual.value - result.value;
      const double whitened = d * d * residual.weight;
      const double root = limit / (limit + whitened);
      const double robust = root * root;
      sum += robust * residual.weight * residual.value;
      information += robust * residual.weight;
      square += robust * whitened;
      weights += robust;
      result.features += whitened < limit;
    }
    result.value = sum / information;
    spread = square / weights;
    result.variance = std::max(1.0, spread) / information;
  }
  return result;
}

std::optional<DisparityMeasurement> DisparityFromDepth::measure(
    const PreparedScan& scan, std::span<const DisparityFeature> features) {
  project(scan);
  residuals_.clear();
  const double focal_baseline = camera_.fx * camera_.baseline;
  for (const DisparityFeature& feature : features) {
    const std::optional<double> z = depth(feature);
    if (!z) continue;
    const double residual = focal_baseline / *z - feature.disparity;
    if (!(std::abs(residual) <= parameters_.max_residual)) continue;
    const double by_depth = focal_baseline / (*z * *z) * parameters_.sigma_depth;
    const double variance = parameters_.sigma_match * parameters_.sigma_match + by_depth * by_depth;
    residuals_.push_back({residual, 1.0 / variance});
  }
  if (static_cast<int>(residuals_.size()) < parameters_.min_features) return std::nullopt;
  return robust_mean();
}

}  // namespace maploop::lidar
