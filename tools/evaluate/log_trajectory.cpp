// Reads a trajectory from our own logs.
#include <stdexcept>

#include "msgs/calibration.h"
#include "msgs/frames.h"
#include "msgs/lcm/channel_names.h"
#include "msgs/nav_state.h"
#include "msgs/reference.h"
#include "tools/evaluate/log_messages.h"
#include "tools/evaluate/trajectory_file.h"

namespace maploop::evaluation {
namespace {

Eigen::Isometry3d camera_of_no_vehicle() {
  Eigen::Isometry3d T_body_cam = Eigen::Isometry3d::Identity();
  T_body_cam.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return T_body_cam;
}

class Builder {
 public:
  void add(Time stamp, const Geodetic& place, const Attitude& attitude) {
    if (!built.stamps.empty() && stamp <= built.stamps.back()) return;  // a replay went back
    if (!built.origin) built.origin = place;
    built.stamps.push_back(stamp);
    built.poses.push_back(Eigen::Translation3d(LocalFrame(*built.origin).to_enu(place)) *
                          Eigen::Isometry3d(rotation_enu_body(attitude)));
  }

  StampedTrajectory built;
};

}  // namespace

StampedTrajectory read_log_trajectory(const std::filesystem::path& file, Role role) {
  namespace names = channel_names;
  const std::string_view channel = role == Role::truth ? names::truth : names::nav_state;
  Builder builder;
  Eigen::Isometry3d T_body_cam = camera_of_no_vehicle();
  visit_log(file, [&](const lcm_log::LogEvent& event) {
    if (event.channel == names::calibration) {
      const auto calibration = decoded<maploop_lcm::calibration_t>(event, file);
      if (calibration.stereo.width > 0) T_body_cam = calibration.stereo.T_body_cam;
    } else if (event.channel != channel) {
      return;
    } else if (role == Role::truth) {
      const auto pose = decoded<maploop_lcm::reference_pose_t>(event, file);
      builder.add(pose.stamp, pose.position, pose.attitude);
    } else {
      const auto state = decoded<maploop_lcm::nav_state_t>(event, file);
      if (state.status == NavStatus::uninitialized) return;
      builder.add(state.stamp, LocalFrame(state.origin).to_geodetic(state.position_enu),
                  state.attitude);
    }
  });
  if (builder.built.poses.empty())
    throw std::runtime_error(file.string() + " has no " + std::string(channel) +
                             "; is it a log of 'maploop replay --record'?");
  for (Eigen::Isometry3d& pose : builder.built.poses) pose = pose * T_body_cam;
  return builder.built;
}

}  // namespace maploop::evaluation
