// This is the least-squares problem that refine_motion solves.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

constexpr double smallest_disparity =
    0.05;  // px; keeps an adjusted point in front of the camera and finite

// These are the equations of the pose's six perturbations (residual.h) and, last, of a constant
// offset of all disparities (px; true = measured + offset), linearized at offset zero.
struct NormalEquations {
  Matrix7 information = Matrix7::Zero();
  Vector7 gradient = Vector7::Zero();
};

// The residuals of a track are current u, v and disparity, and the previous disparity. A match that
// is wrong by half a pixel (on a slanted wall or the edge of a pole) is wrong at both epochs. The
// two disparities therefore share an error of sigma_match, and half their sum has a larger variance
// than half their difference. Each track has one unknown of its own, its true disparity at the
// previous epoch. `tracks` must outlive the object.
class Adjustment {
 public:
  Adjustment(const StereoCalibration& camera, const StereoParameters& parameters,
             std::span<const StereoTrack> tracks);

  // Computes the best disparity (px) of a track for a given T_previous_current; returns the
  // remaining squared whitened residual, which is infinite behind the camera.
  double settle(const Eigen::Isometry3d& pose, int track, double* disparity) const;

  // Returns the Huber cost of the tracks in `inliers` and fills in the best disparity of each.
  double cost(const Eigen::Isometry3d& pose, std::span<const int> inliers,
              std::vector<double>* disparities) const;

  // Returns the equations after the disparities are eliminated by the Schur complement.
  NormalEquations normal_equations(const Eigen::Isometry3d& pose, std::span<const int> inliers,
                                   const std::vector<double>& disparities) const;

 private:
  struct Term {
    bool valid = false;
    Eigen::Vector4d residual;
    Eigen::Matrix<double, 4, 7> by_shared;
    Eigen::Vector4d by_disparity;
  };

  Term linearize(const Eigen::Isometry3d& pose, int track, double disparity) const;
  void whiten(Term* term) const;
  double huber_cost(double squared) const;
  double huber_weight(double squared) const;

  StereoCalibration camera_;
  std::span<const StereoTrack> tracks_;
  double track_weight_, change_weight_, level_weight_;  // 1 / px
  double huber_;
};

}  // namespace maploop::stereo
