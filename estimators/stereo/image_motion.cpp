#include "estimators/stereo/image_motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "msgs/median.h"

namespace maploop::stereo {
namespace {

double median_or_zero(std::vector<double>& values) {
  return values.empty() ? 0.0 : median(values);
}

}  // namespace

ImageMotion image_motion(const StereoCalibration& camera, std::span<const StereoTrack> tracks,
                         std::span<const int> chosen, const Eigen::Isometry3d& T_previous_current) {
  const Eigen::Matrix3d R_current_previous = T_previous_current.linear().transpose();
  std::vector<double> flow, parallax;
  for (const int i : chosen) {
    const StereoObservation& from = tracks[static_cast<std::size_t>(i)].previous;
    const StereoObservation& to = tracks[static_cast<std::size_t>(i)].current;
    flow.push_back(std::hypot(to.u_left - from.u_left, to.v_left - from.v_left));
    const Eigen::Vector3d ray =
        R_current_previous * Eigen::Vector3d((from.u_left - camera.cx) / camera.fx,
                                             (from.v_left - camera.cy) / camera.fy, 1.0);
    if (!(ray.z() > 0.0)) continue;
    parallax.push_back(std::hypot(to.u_left - camera.cx - camera.fx * ray.x() / ray.z(),
                                  to.v_left - camera.cy - camera.fy * ray.y() / ray.z()));
  }
  return {median_or_zero(flow), median_or_zero(parallax)};
}

}  // namespace maploop::stereo
