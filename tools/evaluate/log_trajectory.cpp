// Reads a trajectory from our own logs.
#include <optional>
#include <stdexcept>
#include <vector>

#include "msgs/calibration.h"
#include "msgs/frames.h"
#include "msgs/lcm/channel_names.h"
#include "msgs/nav_state.h"
#include "msgs/reference.h"
#include "msgs/vehicle_description.h"
#include "tools/evaluate/log_messages.h"
#include "tools/evaluate/trajectory_file.h"

namespace maploop::evaluation {
namespace {

struct Place {
  Time stamp;
  Geodetic position;
  Attitude attitude;
};

// Stamps that do not increase are left out: a replay went back.
StampedTrajectory in_frame(const std::vector<Place>& places, const Geodetic& origin,
                           const Eigen::Isometry3d& T_body_cam) {
  StampedTrajectory trajectory;
  trajectory.origin = origin;
  const LocalFrame frame(origin);
  for (const Place& place : places) {
    if (!trajectory.stamps.empty() && place.stamp <= trajectory.stamps.back()) continue;
    trajectory.stamps.push_back(place.stamp);
    trajectory.poses.push_back(Eigen::Translation3d(frame.to_enu(place.position)) *
                               Eigen::Isometry3d(rotation_enu_body(place.attitude)) * T_body_cam);
  }
  return trajectory;
}

}  // namespace

StampedTrajectory read_log_trajectory(const std::filesystem::path& file, Role role) {
  namespace names = channel_names;
  const std::string_view channel = role == Role::truth ? names::truth : names::nav_state;
  std::vector<Place> places;
  std::optional<Geodetic> origin;  // of the run's own frame, in which its --tum is
  Eigen::Isometry3d T_body_cam = camera_pose({}, {});
  visit_log(file, [&](const lcm_log::LogEvent& event) {
    if (event.channel == names::calibration) {
      const auto calibration = decoded<maploop_lcm::calibration_t>(event, file);
      if (calibration.stereo.width > 0) T_body_cam = calibration.stereo.T_body_cam;
    } else if (event.channel == names::truth && role == Role::truth) {
      const auto pose = decoded<maploop_lcm::reference_pose_t>(event, file);
      places.push_back({pose.stamp, pose.position, pose.attitude});
    } else if (event.channel == names::nav_state && (role == Role::estimate || !origin)) {
      const auto state = decoded<maploop_lcm::nav_state_t>(event, file);
      if (state.status == NavStatus::uninitialized) return;
      if (!origin) origin = state.origin;
      if (role == Role::truth) return;
      places.push_back(
          {state.stamp, LocalFrame(state.origin).to_geodetic(state.position_enu), state.attitude});
    }
  });
  if (places.empty()) {
    throw std::runtime_error(file.string() + " has no " + std::string(channel) +
                             "; is it a log of 'maploop replay --record'?");
  }
  return in_frame(places, origin.value_or(places.front().position), T_body_cam);
}

}  // namespace maploop::evaluation
