#include "sensors/camera/camera_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>
#include <vector>

namespace maploop::sensors {
namespace {

std::vector<Eigen::Vector2d> pixel_grid(int width, int height) {
  constexpr int cells = 40;
  std::vector<Eigen::Vector2d> grid;
  for (int i = 0; i <= cells; ++i) {
    for (int k = 0; k <= cells; ++k)
      grid.emplace_back((width - 1.0) * k / cells, (height - 1.0) * i / cells);
  }
  return grid;
}

double largest_distance(const CameraModel& camera, const Distortion& distortion,
                        const std::vector<Eigen::Vector2d>& from,
                        const std::vector<Eigen::Vector2d>& to) {
  double largest = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector2d fitted = apply(distortion, from[i]).point;
    largest = std::max(largest, (camera.pixel(fitted) - camera.pixel(to[i])).norm());
  }
  return largest;
}

}  // namespace

std::optional<Eigen::Vector2d> project(const CameraModel& camera, const Eigen::Vector2d& ray) {
  if (!is_lens(camera.distortion, ray)) return std::nullopt;
  return camera.pixel(apply(camera.distortion, ray).point);
}

std::optional<Eigen::Vector2d> ray_of(const CameraModel& camera, const Eigen::Vector2d& pixel) {
  constexpr int max_iterations = 30;
  constexpr double enough = 1e-13;
  const Eigen::Vector2d distorted = camera.normalized(pixel);
  Eigen::Vector2d x = distorted;
  for (int i = 0; i < max_iterations; ++i) {
    const DistortedPoint at = apply(camera.distortion, x);
    const Eigen::Vector2d step = at.by_point.inverse() * (distorted - at.point);
    if (!step.allFinite()) return std::nullopt;
    x += step;
    if (step.norm() < enough)
      return is_lens(camera.distortion, x) ? std::optional(x) : std::nullopt;
  }
  return std::nullopt;
}

ReversedDistortion reversed(const CameraModel& camera, int width, int height) {
  std::vector<Eigen::Vector2d> distorted, undistorted;
  const std::vector<Eigen::Vector2d> pixels = pixel_grid(width, height);
  for (const Eigen::Vector2d& pixel : pixels) {
    const auto ray = ray_of(camera, pixel);
    if (!ray) continue;
    distorted.push_back(camera.normalized(pixel));
    undistorted.push_back(*ray);
  }
  if (2 * distorted.size() < pixels.size()) {
    throw std::runtime_error(
        "the distortion is not that of a lens: it folds back in most of the image");
  }
  const Distortion fitted = fit_distortion(distorted, undistorted);
  return {fitted, largest_distance(camera, fitted, distorted, undistorted)};
}

ReversedDistortion from_reversed(const CameraModel& camera, int width, int height) {
  std::vector<Eigen::Vector2d> distorted, undistorted;
  for (const Eigen::Vector2d& pixel : pixel_grid(width, height)) {
    distorted.push_back(camera.normalized(pixel));
    undistorted.push_back(apply(camera.distortion, distorted.back()).point);
  }
  const Distortion fitted = fit_distortion(undistorted, distorted);
  return {fitted, largest_distance(camera, fitted, undistorted, distorted)};
}

}  // namespace maploop::sensors
