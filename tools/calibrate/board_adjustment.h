// Least squares adjustment of both cameras, their relative pose and the pose of the board in each
// view; and its starting values.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "sensors/camera/stereo_rig.h"
#include "tools/calibrate/board.h"

namespace maploop::calibrate {

// One pair of images in which the board was found. Corners correspond to Board::points().
struct View {
  std::string name;
  Corners left, right;
};

// The parameters common to all views, in the order of Adjustment::sigma: left fx fy cx cy k1 k2 p1
// p2 k3, the same for right, rotation of the right camera about its own x y z (rad), t_right_left
// (m).
constexpr int camera_parameter_count = 9, common_parameter_count = 2 * camera_parameter_count + 6;
using CommonVector = Eigen::Matrix<double, common_parameter_count, 1>;
constexpr std::array<const char*, camera_parameter_count> camera_parameter_names = {
    "fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
// Returns the numbers of a camera that have these names.
inline std::array<double*, camera_parameter_count> numbers_of(sensors::CameraModel& c) {
  sensors::Distortion& d = c.distortion;
  return {&c.fx, &c.fy, &c.cx, &c.cy, &d.k1, &d.k2, &d.p1, &d.p2, &d.k3};
}

struct Cameras {
  sensors::CameraModel left, right;
  Eigen::Isometry3d T_right_left = Eigen::Isometry3d::Identity();
};

// Measured - projected corners, px; for each view, left and right.
using Residuals = std::vector<std::array<Corners, 2>>;
Residuals residuals_at(const Board& board, const std::vector<View>& views, const Cameras& cameras,
                       const std::vector<Eigen::Isometry3d>& T_left_board);

struct Adjustment {
  Cameras cameras;
  std::vector<Eigen::Isometry3d> T_left_board;  // for each view
  Residuals residuals;
  double rms = 0.0;  // px, root mean square distance between measured and projected corners
  // One standard deviation of each common parameter. The noise of the corners is estimated from the
  // residuals, and assumed to be independent from corner to corner.
  CommonVector sigma = CommonVector::Zero();
  bool converged = false;
};

// Returns the root mean square distance in the left and the right image of one view, px.
std::array<double, 2> rms_of(const std::array<Corners, 2>& residuals);
// Returns the root mean square distance of both images together, px.
double rms_of_view(const std::array<Corners, 2>& residuals);

// Minimizes with Levenberg-Marquardt from `start`, in at most 50 steps; the views' poses are
// eliminated (Schur complement). Throws std::runtime_error if the views do not determine a
// parameter.
Adjustment adjust(const Board& board, const std::vector<View>& views, const Cameras& start,
                  std::vector<Eigen::Isometry3d> T_left_board);

// A projected point (px) and its derivatives with respect to the camera's nine parameters and to
// the point in the camera's frame (m).
struct Projection {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, camera_parameter_count> by_camera;
  Eigen::Matrix<double, 2, 3> by_point;
};
Projection project_with_derivatives(const sensors::CameraModel& camera,
                                    const Eigen::Vector3d& point);

struct StartingValues {
  Cameras cameras;
  std::vector<Eigen::Isometry3d> T_left_board;
};

// Calibrates each camera independently (Zhang 2000, by OpenCV), and takes the median over the views
// for the pose between the cameras. Throws std::runtime_error if no camera fits.
StartingValues starting_values(const Board& board, const std::vector<View>& views, int width,
                               int height);

}  // namespace maploop::calibrate
