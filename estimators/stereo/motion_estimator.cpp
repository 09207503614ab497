#include "estimators/stereo/motion_estimator.h"

#include <algorithm>
#include <cmath>

#include "estimators/stereo/epipolar_motion.h"
#include "estimators/stereo/point_alignment.h"
#include "estimators/stereo/ransac.h"
#include "estimators/stereo/refine.h"
#include "estimators/stereo/residual.h"
#include "estimators/stereo/stereo_match.h"
#include "msgs/small_turn.h"

namespace maploop::stereo {
namespace {

bool usable(const StereoObservation& seen, const StereoParameters& parameters) {
  return std::isfinite(seen.u_left) && std::isfinite(seen.v_left) && std::isfinite(seen.u_right) &&
         std::isfinite(seen.v_right) && consistent(seen, parameters);
}

struct Guess {
  std::span<const StereoTrack> tracks;
  std::uint64_t seed;
  double offset_sigma;
  const std::optional<MotionPrior>& prior;
};

// Estimates the motion by the selected method; `enough` tests the consensus before it is refined.
template <class Enough>
Refinement find_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                       const Guess& guess, const Enough& enough, const StageListener& stage) {
  if (parameters.motion == MotionMethod::image_to_image) {
    Refinement found = epipolar_motion(camera, parameters, guess.tracks, 1.0);
    notify(stage, "epipolar");
    return found;
  }
  const auto expected =
      guess.prior ? std::optional(guess.prior->T_previous_current.inverse()) : std::nullopt;
  const Consensus consensus = ransac_motion(camera, parameters, guess.tracks, guess.seed, expected);
  notify(stage, "consensus");
  if (!enough(consensus.inliers)) return {};
  Refinement refined =
      parameters.motion == MotionMethod::points_to_points
          ? refine_alignment(camera, parameters, guess.tracks, consensus.inliers, guess.prior)
          : refine_motion(camera, parameters, guess.tracks, consensus.inliers,
                          consensus.T_current_previous.inverse(), guess.offset_sigma, guess.prior);
  notify(stage, "refinement");
  return refined;
}

}  // namespace

CameraMotion estimate_motion(const StereoCalibration& camera, const StereoParameters& parameters,
                             std::span<const StereoTrack> tracks, std::uint64_t seed,
                             const DisparityOffset& offset, const std::optional<MotionPrior>& prior,
                             const StageListener& stage) {
  CameraMotion motion;
  std::vector<StereoTrack> good;
  std::vector<int> index_of;
  good.reserve(tracks.size());
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (!usable(tracks[i].previous, parameters) || !usable(tracks[i].current, parameters)) continue;
    good.push_back(tracks[i]);
    good.back().previous.u_right -= offset.value();  // (1) of METHOD.md
    good.back().current.u_right -= offset.value();
    index_of.push_back(static_cast<int>(i));
  }
  motion.tracked = static_cast<int>(good.size());
  if (motion.tracked < parameters.min_tracks) return motion;

  const auto enough = [&](const std::vector<int>& inliers) {
    return static_cast<int>(inliers.size()) >= parameters.min_inliers &&
           static_cast<double>(inliers.size()) >= parameters.min_inlier_ratio * motion.tracked;
  };
  motion.status = OdometryStatus::too_few_inliers;
  Refinement refined =
      find_motion(camera, parameters, {good, seed, offset.sigma(), prior}, enough, stage);
  if (!refined.ok || !enough(refined.inliers)) return motion;

  motion.status = OdometryStatus::ok;
  motion.T_previous_current = refined.T_previous_current;
  motion.covariance = refined.covariance;
  motion.by_offset = refined.by_offset;
  motion.offset = refined.offset;
  motion.offset_sigma = refined.offset_sigma;
  for (const int i : refined.inliers)
    motion.inliers.push_back(index_of[static_cast<std::size_t>(i)]);
  return motion;
}

void lengthen(CameraMotion* motion, double length) {
  constexpr double standing_sigma = 0.02;  // m, standard deviation: 0.3 px at a distance of 10 m
  motion->T_previous_current.translation() *= length;
  motion->covariance.topRows<3>() *= length;
  motion->covariance.leftCols<3>() *= length;
  if (length == 0.0) {
    motion->covariance.topLeftCorner<3, 3>() =
        standing_sigma * standing_sigma * Eigen::Matrix3d::Identity();
  }
}

namespace {

// Returns the derivative of the body's motion with respect to the camera's. With the camera's lever
// l, t_body = R_body_cam t_cam + l - R l: a rotation error of the camera also moves the body, by [R
// l]x.
Eigen::Matrix<double, 6, 6> body_by_camera(const Eigen::Isometry3d& T_body_cam,
                                           const Eigen::Isometry3d& T) {
  const Eigen::Matrix3d R_body_cam = T_body_cam.linear();
  const Eigen::Vector3d lever = T.linear() * T_body_cam.translation();
  Eigen::Matrix<double, 6, 6> J = Eigen::Matrix<double, 6, 6>::Zero();
  J.topLeftCorner<3, 3>() = R_body_cam;
  J.topRightCorner<3, 3>() = cross_matrix(lever) * R_body_cam;
  J.bottomRightCorner<3, 3>() = R_body_cam;
  return J;
}

Eigen::Isometry3d of_body(const Eigen::Isometry3d& T_body_cam, const CameraMotion& motion) {
  return T_body_cam * motion.T_previous_current * T_body_cam.inverse();
}

}  // namespace

void to_body(const Eigen::Isometry3d& T_body_cam, const CameraMotion& motion,
             RelativeMotion* result) {
  const Eigen::Isometry3d T = of_body(T_body_cam, motion);
  result->translation = T.translation();
  result->rotation = Eigen::Quaterniond(T.linear()).normalized();
  const Eigen::Matrix<double, 6, 6> J = body_by_camera(T_body_cam, T);
  result->covariance = J * motion.covariance * J.transpose();
}

Eigen::Matrix<double, 6, 1> offset_effect_on_body(const Eigen::Isometry3d& T_body_cam,
                                                  const CameraMotion& motion) {
  return body_by_camera(T_body_cam, of_body(T_body_cam, motion)) * motion.by_offset;
}

}  // namespace maploop::stereo
