// The least-squares problem behind refine_motion.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

// The unknowns all tracks share. Their seven perturbations: the pose's six (residual.h), then the
// offset.
struct SharedUnknowns {
  Eigen::Isometry3d T_previous_current = Eigen::Isometry3d::Identity();  // cam
  double disparity_offset = 0.0;  // px; true disparity = measured + offset
};

using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

SharedUnknowns perturbed(const SharedUnknowns& unknowns, const Vector7& perturbation);

struct NormalEquations {
  Matrix7 information = Matrix7::Zero();  // of the tracks alone
  double prior = 0.0;                     // information on the offset that was there before
  Vector7 gradient = Vector7::Zero();     // of both
};

// Residuals of a track: current u, v and disparity, previous disparity. A match that is wrong by
// half a pixel (a slanted wall, the rim of a pole) is wrong at both epochs, so the two disparities
// share an error of sigma_match: their half sum is known worse than their half difference. Each
// track's own unknown is its true disparity at the previous epoch. `tracks` must outlive the object.
class Adjustment {
 public:
  Adjustment(const StereoCalibration& camera, const StereoParameters& parameters,
             std::span<const StereoTrack> tracks, double offset_sigma);

  // Best disparity of a track for given shared unknowns, and the squared residual that is left;
  // infinite behind the camera.
  double settle(const SharedUnknowns& unknowns, int track, double* disparity) const;

  // Huber cost of the tracks named with every disparity settled, and that of the offset's prior.
  double prior_cost(const SharedUnknowns& unknowns) const;
  double cost(const SharedUnknowns& unknowns, std::span<const int> inliers,
              std::vector<double>* disparities) const;

  // Of the shared unknowns; the disparities are eliminated by the Schur complement.
  NormalEquations normal_equations(const SharedUnknowns& unknowns, std::span<const int> inliers,
                                   const std::vector<double>& disparities) const;

 private:
  struct Term {
    bool valid = false;
    Eigen::Vector4d residual;
    Eigen::Matrix<double, 4, 7> by_shared;
    Eigen::Vector4d by_disparity;
  };

  Term linearize(const SharedUnknowns& unknowns, int track, double disparity) const;
  void whiten(Term* term) const;
  double huber_cost(double squared) const;
  double huber_weight(double squared) const;

  StereoCalibration camera_;
  std::span<const StereoTrack> tracks_;
  double track_weight_, change_weight_, level_weight_, offset_weight_;  // 1 / px
  double huber_;
};

}  // namespace maploop::stereo
