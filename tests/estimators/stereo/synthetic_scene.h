// The scene has points in front of a moving stereo camera, and what the camera sees of them.
#pragma once

#include <Eigen/Geometry>
#include <numeric>
#include <random>
#include <vector>

#include "estimators/stereo/tracks.h"
#include "estimators/stereo/triangulate.h"

namespace maploop::testing {

inline StereoCalibration small_camera() {
  StereoCalibration camera;
  camera.width = 640;
  camera.height = 240;
  camera.fx = camera.fy = 400.0;
  camera.cx = 320.0;
  camera.cy = 120.0;
  camera.baseline = 0.5;
  return camera;
}

// Returns a motion of one metre forward with small other components: T_previous_current in cam.
inline Eigen::Isometry3d driving_motion() {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() =
      Eigen::AngleAxisd(0.03, Eigen::Vector3d(0.1, 1.0, -0.2).normalized()).toRotationMatrix();
  motion.translation() = Eigen::Vector3d(0.05, -0.02, 1.0);
  return motion;
}

struct ImageNoise {
  double track = 0.0;      // px, current left position
  double disparity = 0.0;  // px, independent in each disparity
  double match = 0.0;      // px, shared by both disparities
  double offset = 0.0;     // px, constant offset missing in every disparity
};

// Returns tracks of `count` points between 5 and 60 m, spread over the previous image.
inline std::vector<stereo::StereoTrack> synthetic_tracks(const StereoCalibration& camera,
                                                         const Eigen::Isometry3d& motion, int count,
                                                         const ImageNoise& noise, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(20.0, camera.width - 20.0),
      v(20.0, camera.height - 20.0);
  std::uniform_real_distribution<double> inverse_depth(1.0 / 60.0, 1.0 / 5.0);
  std::normal_distribution<double> normal;
  std::vector<stereo::StereoTrack> tracks;
  for (int i = 0; i < count; ++i) {
    const double disparity = camera.fx * camera.baseline * inverse_depth(random);
    const stereo::ImagePoint before(u(random), v(random), disparity);
    const stereo::ImagePoint after =
        stereo::project(camera, motion.inverse() * stereo::triangulate(camera, before));
    const double shared = noise.match * normal(random) - noise.offset;
    const double first = before.z() + shared + noise.disparity * normal(random);
    const double second = after.z() + shared + noise.disparity * normal(random);
    const double u_now = after.x() + noise.track * normal(random);
    const double v_now = after.y() + noise.track * normal(random);
    tracks.push_back({i,
                      {before.x(), before.y(), before.x() - first, before.y()},
                      {u_now, v_now, u_now - second, v_now}});
  }
  return tracks;
}

// Returns the indices of all tracks.
inline std::vector<int> all_of(const std::vector<stereo::StereoTrack>& tracks) {
  std::vector<int> indices(tracks.size());
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

// Returns the difference of two poses in the convention of the covariance: translation, then
// rotation vector.
inline Eigen::Matrix<double, 6, 1> pose_error(const Eigen::Isometry3d& estimate,
                                              const Eigen::Isometry3d& truth) {
  const Eigen::AngleAxisd turn(estimate.linear() * truth.linear().transpose());
  Eigen::Matrix<double, 6, 1> error;
  error << estimate.translation() - truth.translation(), turn.angle() * turn.axis();
  return error;
}

}  // namespace maploop::testing
