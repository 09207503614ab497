#include "sensors/camera/rectification.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace maploop::sensors {
namespace {

constexpr int steps = 200;      // samples along a border
constexpr double widest = 2.0;  // at unit depth, to each side: 127 deg in all

// A field of rectified rays: x and y at unit depth.
struct Field {
  double left = -widest, right = widest, top = -widest, bottom = widest;

  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

// Shrinks the field to the inside of a raw image's border. Border pixels without a ray, which lie
// beyond the range where the lens was measured, do not restrict it.
void cut(Field& field, const CameraModel& camera, const Eigen::Matrix3d& R_rect, int width,
         int height) {
  const auto ray = [&](double u, double v, double otherwise) -> Eigen::Vector2d {
    const auto raw = ray_of(camera, {u, v});
    if (!raw) return Eigen::Vector2d::Constant(otherwise);
    const Eigen::Vector3d turned = R_rect * raw->homogeneous();
    if (!(turned.z() > 0.0)) return Eigen::Vector2d::Constant(otherwise);
    return turned.hnormalized();
  };
  constexpr double least = -widest, most = widest;
  for (int i = 0; i <= steps; ++i) {
    const double u = (width - 1.0) * i / steps, v = (height - 1.0) * i / steps;
    field.left = std::max(field.left, ray(0.0, v, least).x());
    field.right = std::min(field.right, ray(width - 1.0, v, most).x());
    field.top = std::max(field.top, ray(u, 0.0, least).y());
    field.bottom = std::min(field.bottom, ray(u, height - 1.0, most).y());
  }
}

// Whether a raw camera sees the whole border of its rectified image.
bool sees(const CameraModel& camera, const Eigen::Matrix3d& R_rect, const StereoRig& rig) {
  const StereoCalibration& r = rig.rectified;
  const auto is_seen = [&](double u, double v) {
    constexpr double rounding = 1e-3;  // px
    const Eigen::Vector3d ray =
        R_rect.transpose() * Eigen::Vector3d((u - r.cx) / r.fx, (v - r.cy) / r.fy, 1.0);
    if (!(ray.z() > 0.0)) return false;
    const auto at = project(camera, ray.hnormalized());
    return at && at->minCoeff() > -rounding && at->x() < rig.width - 1.0 + rounding &&
           at->y() < rig.height - 1.0 + rounding;
  };
  for (int i = 0; i <= steps; ++i) {
    const double u = (r.width - 1.0) * i / steps, v = (r.height - 1.0) * i / steps;
    if (!is_seen(u, 0.0) || !is_seen(u, r.height - 1.0) || !is_seen(0.0, v) ||
        !is_seen(r.width - 1.0, v))
      return false;
  }
  return true;
}

Eigen::Matrix3d half(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd whole(rotation);
  return Eigen::AngleAxisd(0.5 * whole.angle(), whole.axis()).matrix();
}

}  // namespace

StereoRig rectify(const CameraModel& left, const CameraModel& right,
                  const Eigen::Isometry3d& T_right_left, int width, int height) {
  StereoRig rig;
  rig.width = width;
  rig.height = height;
  rig.left = left;
  rig.right = right;
  rig.T_right_left = T_right_left;

  const Eigen::Matrix3d R_half = half(T_right_left.linear());
  // The vector from the left to the right camera, in the frame half way between their rotations.
  const Eigen::Vector3d to_right = -(R_half.transpose() * T_right_left.translation());
  if (!(to_right.x() > 0.7 * to_right.norm())) {
    throw std::runtime_error(
        "the right camera does not stand to the right of the left one, but at x " +
        std::to_string(to_right.x()) + ", y " + std::to_string(to_right.y()) + ", z " +
        std::to_string(to_right.z()) + " m: are left and right swapped?");
  }
  const Eigen::Matrix3d R_level =
      Eigen::Quaterniond::FromTwoVectors(to_right, Eigen::Vector3d::UnitX()).matrix();
  rig.R_rect_left = R_level * R_half;
  rig.R_rect_right = R_level * R_half.transpose();

  Field field;
  cut(field, rig.left, rig.R_rect_left, width, height);
  cut(field, rig.right, rig.R_rect_right, width, height);
  if (!(field.width() > 0.0 && field.height() > 0.0))
    throw std::runtime_error("the two cameras have no field of view in common");
  StereoCalibration& r = rig.rectified;
  r.width = width;
  r.height = height;
  r.baseline = to_right.norm();
  double f = std::max((width - 1.0) / field.width(), (height - 1.0) / field.height());
  const double narrowest = 4.0 * f;
  do {
    if (f > narrowest) {
      throw std::runtime_error(
          "no field of view is left where the distortion that was found is a lens: show the board "
          "near all borders of the images");
    }
    r.fx = r.fy = f;
    r.cx = 0.5 * (width - 1.0) - f * 0.5 * (field.left + field.right);
    r.cy = 0.5 * (height - 1.0) - f * 0.5 * (field.top + field.bottom);
    f *= 1.002;
  } while (!sees(rig.left, rig.R_rect_left, rig) || !sees(rig.right, rig.R_rect_right, rig));
  return rig;
}

}  // namespace maploop::sensors
