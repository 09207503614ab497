// This file models one raw camera as a pinhole with lens distortion.
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

// Returns the pixel at which the undistorted ray (x, y, 1) meets the image. Returns nothing where
// the model is no longer a valid lens (is_lens).
std::optional<Eigen::Vector2d> project(const CameraModel& camera, const Eigen::Vector2d& ray);

// Returns the undistorted ray (x, y, at unit depth) of a pixel by Newton's method, or nothing if no
// ray ends there.
std::optional<Eigen::Vector2d> ray_of(const CameraModel& camera, const Eigen::Vector2d& pixel);

// These coefficients work in the other direction. They are fitted over a grid that covers the
// image, because five coefficients cannot reverse five others exactly.
struct ReversedDistortion {
  Distortion distortion;
  double largest_error = 0.0;  // px, of the fit
};

// Converts the coefficients of `camera`, undistorted -> distorted, to distorted -> undistorted.
// Pixels at which no ray ends are ignored; throws std::runtime_error if they are the majority.
ReversedDistortion reversed(const CameraModel& camera, int width, int height);

// Converts back: `camera` has coefficients distorted -> undistorted.
ReversedDistortion from_reversed(const CameraModel& camera, int width, int height);

}  // namespace maploop::sensors
