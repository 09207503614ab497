#include "estimators/stereo/window.h"

#include <algorithm>

#include "msgs/median.h"

namespace maploop::stereo {

std::size_t WindowPoint::first_seen(std::size_t poses) const {
  std::size_t i = 0;
  while (i < poses && !sights[i].seen) ++i;
  return i;
}

Window::Window(const StereoParameters& parameters)
    : most_poses_(static_cast<std::size_t>(parameters.window_frames)),
      most_points_(static_cast<std::size_t>(parameters.window_max_points)),
      min_flow_(parameters.window_min_flow) {
  poses.reserve(most_poses_);
  points.reserve(most_points_);
  flows_.reserve(most_points_);
}

std::size_t Window::largest_archive(const StereoParameters& parameters) {
  if (parameters.window_frames == 0) return 0;
  return static_cast<std::size_t>(parameters.window_frames) * sizeof(WindowPose) +
         static_cast<std::size_t>(parameters.window_max_points) * sizeof(WindowPoint);
}

void Window::clear() {
  poses.clear();
  points.clear();
}

void Window::add(const StereoCalibration& camera, Time stamp, const Eigen::Isometry3d& T_world_cam,
                 std::span<const StereoTrack> tracks, std::span<const int> chosen, double offset) {
  const auto seen_at = [offset](const StereoObservation& at) {
    return WindowPoint::Sight{true, {at.u_left, at.v_left, at.disparity() + offset}};
  };
  const auto known = [this](std::int64_t id) {
    return std::find_if(points.begin(), points.end(),
                        [id](const WindowPoint& p) { return p.id == id; });
  };
  // New points are added before room is made, since a track's first sight is in the newest pose.
  const std::size_t newest_pose = poses.size() - 1;
  for (const int i : chosen) {
    const StereoTrack& track = tracks[static_cast<std::size_t>(i)];
    if (known(track.id) != points.end() || points.size() == most_points_) continue;
    WindowPoint& point = points.emplace_back();
    point.id = track.id;
    point.sights[newest_pose] = seen_at(track.previous);
    point.p_world = poses.back().T_world_cam * triangulate(camera, point.sights[newest_pose].image);
  }
  make_room();
  poses.push_back({stamp, T_world_cam});
  for (const int i : chosen) {
    const StereoTrack& track = tracks[static_cast<std::size_t>(i)];
    const auto point = known(track.id);
    if (point != points.end()) point->sights[poses.size() - 1] = seen_at(track.current);
  }
  std::erase_if(points,
                [&](const WindowPoint& p) { return p.first_seen(poses.size()) == poses.size(); });
}

void Window::make_room() {
  if (poses.size() >= 2 && flow_of_newest() < min_flow_) {
    remove_pose(poses.size() - 1);
  } else if (poses.size() == most_poses_) {
    remove_pose(0);
  }
}

void Window::remove_pose(std::size_t index) {
  poses.erase(poses.begin() + static_cast<std::ptrdiff_t>(index));
  for (WindowPoint& point : points) {
    std::move(point.sights.begin() + static_cast<std::ptrdiff_t>(index) + 1, point.sights.end(),
              point.sights.begin() + static_cast<std::ptrdiff_t>(index));
    point.sights.back() = {};
  }
}

double Window::flow_of_newest() const {
  flows_.clear();
  const std::size_t last = poses.size() - 1;
  for (const WindowPoint& point : points) {
    if (point.sights[last].seen && point.sights[last - 1].seen)
      flows_.push_back((point.sights[last].image - point.sights[last - 1].image).head<2>().norm());
  }
  return flows_.empty() ? min_flow_ : median(flows_);
}

}  // namespace maploop::stereo
