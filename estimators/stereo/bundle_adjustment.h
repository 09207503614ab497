// This is the windowed bundle adjustment (thesis section 3.13).
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/window.h"

namespace maploop::stereo {

// Adjusts all poses of a window except the first, and all its points, by Levenberg-Marquardt. The
// residuals are left positions and disparities of all sights, with Huber weights and without those
// beyond outlier_sigmas; each point's match error, with sigma_match; and the change of velocity
// from one motion to the next, since a vehicle has inertia (sigma_acceleration,
// sigma_turn_acceleration). Points are eliminated by the Schur complement. The first pose is the
// gauge.
//
// A point is parameterized in the image of the pose that saw it first (u, v, disparity), where far
// points behave as well as near ones. Never allocates after construction; takes at most
// window_iterations.
class BundleAdjustment {
 public:
  BundleAdjustment(const StereoCalibration& camera, const StereoParameters& parameters);

  // Returns false if the equations have no finite solution; the window may have changed then.
  bool adjust(Window* window);

  // Returns the covariance of the motion between the two newest poses of an adjusted window:
  // translation (m), then rotation vector (rad), in cam at the earlier pose (residual.h). It is
  // scaled by the residuals' own variance and by correlated_pairs, as in refine.h. Returns nothing
  // if the window has fewer than three poses or too few sights.
  std::optional<Eigen::Matrix<double, 6, 6>> newest_covariance(const Window& window);

  // Returns twice the cost that adjust() minimizes.
  double cost(const Window& window) const;

 private:
  static constexpr int largest_size = 6 * static_cast<int>(largest_window);
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, largest_size, largest_size>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, largest_size, 1>;
  using Vector4 = Eigen::Vector4d;  // of a point: u, v, disparity, match error, px

  struct Term {
    bool valid = false;
    Eigen::Vector3d residual;
    Eigen::Matrix<double, 3, 6> by_pose;
    Eigen::Matrix<double, 3, 4> by_point;
  };
  struct PointEquations {
    Eigen::Matrix4d information;
    Vector4 gradient;
    std::array<Eigen::Matrix<double, 6, 4>, largest_window> coupling;
  };

  void set_up(const Window& window);
  double square(const Window& window, const WindowPoint& point, std::size_t pose) const;
  Term linearize(const Window& window, const WindowPoint& point, std::size_t pose,
                 const Eigen::Matrix3d& point_by_image) const;
  void add_velocity_changes(const Window& window);
  void add_points(const Window& window);
  void eliminate_points(const Window& window, double damping);
  void step(const Window& from, const Vector& of_poses, double damping, Window* to) const;
  double robust_cost(double squared) const;
  double robust_weight(double squared) const;

  StereoCalibration camera_;
  Eigen::Vector3d weight_;                     // of u, v, disparity; 1 / px
  double match_weight_;                        // 1 / px
  Eigen::Matrix<double, 6, 1> change_weight_;  // of a velocity's change over one second
  double huber_, outlier_;                     // whitened
  double correlated_pairs_;
  int max_iterations_;

  Matrix information_;  // of all poses but the first
  Vector gradient_;
  std::vector<PointEquations> equations_;  // one a point
  Window tried_;
};

}  // namespace maploop::stereo
