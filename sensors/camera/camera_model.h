// One raw camera: pinhole with lens distortion.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "sensors/camera/distortion.h"

namespace maploop::sensors {

// The centre of the upper left pixel is (0, 0). Camera frame: x right, y down, z forward.
struct CameraModel {
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  // px
  Distortion distortion;                          // undistorted -> distorted

  Eigen::Vector2d pixel(const Eigen::Vector2d& distorted) const {
    return {fx * distorted.x() + cx, fy * distorted.y() + cy};
  }
  Eigen::Vector2d normalized(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy};
  }
};

// Where a ray through (x, y, 1), undistorted, meets the image. Nothing where the model is no lens
// any more: far outside of the image the polynomial turns back, and would show a second time what
// is seen already.
std::optional<Eigen::Vector2d> project(const CameraModel& camera, const Eigen::Vector2d& ray);

// The ray of a pixel, by Newton's method; nothing where no ray ends there.
std::optional<Eigen::Vector2d> ray_of(const CameraModel& camera, const Eigen::Vector2d& pixel);

// Coefficients of the other direction, fitted over a grid that covers the image: five coefficients
// cannot reverse five others exactly.
struct ReversedDistortion {
  Distortion distortion;
  double largest_error = 0.0;  // px, of the fit
};

// From undistorted -> distorted, as `camera` has them, to distorted -> undistorted. Pixels
// that no ray ends at do not count; throws std::runtime_error where they are most.
ReversedDistortion reversed(const CameraModel& camera, int width, int height);

// The way back: `camera` has coefficients distorted -> undistorted.
ReversedDistortion from_reversed(const CameraModel& camera, int width, int height);

}  // namespace maploop::sensors
