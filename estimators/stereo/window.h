// The window holds the last keyframes and their shared points for the bundle adjustment.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "estimators/stereo/tracks.h"
#include "estimators/stereo/triangulate.h"
#include "msgs/calibration.h"
#include "msgs/time.h"

namespace maploop::stereo {

inline constexpr std::size_t largest_window = 12;  // poses

struct WindowPose {
  Time stamp{};
  Eigen::Isometry3d T_world_cam = Eigen::Isometry3d::Identity();

  template <class Archive>
  void archive(Archive& ar) {
    ar(stamp, T_world_cam);
  }
};

struct WindowPoint {
  struct Sight {
    bool seen = false;
    ImagePoint image = ImagePoint::Zero();  // u, v, disparity; px

    template <class Archive>
    void archive(Archive& ar) {
      ar(seen, image);
    }
  };

  std::int64_t id = 0;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  double match_error = 0.0;  // px, measured - true, in every disparity of this feature
  std::array<Sight, largest_window> sights;  // by pose, oldest first

  std::size_t first_seen(std::size_t poses) const;  // `poses` if no pose sees it

  template <class Archive>
  void archive(Archive& ar) {
    ar(id, p_world, match_error, sights);
  }
};

// Holds plain data, all of which is archived. `world` is the frame of the first pose that was ever
// added. The size is bounded by window_frames and window_max_points; never allocates after
// construction.
class Window {
 public:
  explicit Window(const StereoParameters& parameters);

  void clear();
  bool empty() const { return poses.empty(); }
  const WindowPose& newest() const { return poses.back(); }

  // Adds a pose and the tracks in `chosen` that lead to it from the newest one. New points are
  // triangulated where they were first seen; `offset` (px) is added to every disparity. Makes room
  // first: removes the newest pose if it hardly moved against the one before it (window_min_flow),
  // so that a standing car keeps its baseline; otherwise removes the oldest pose of a full window.
  void add(const StereoCalibration& camera, Time stamp, const Eigen::Isometry3d& T_world_cam,
           std::span<const StereoTrack> tracks, std::span<const int> chosen, double offset);

  static std::size_t largest_archive(const StereoParameters& parameters);

  template <class Archive>
  void archive(Archive& ar) {
    ar(poses, points);
    if constexpr (Archive::loading) {
      if (poses.size() > most_poses_ || points.size() > most_points_) {
        ar.fail("a window larger than window_frames and window_max_points");
      }
    }
  }

  std::vector<WindowPose> poses;    // oldest first
  std::vector<WindowPoint> points;  // in no order

 private:
  void make_room();
  void remove_pose(std::size_t index);
  double flow_of_newest() const;  // px, median over the points that both newest poses see

  std::size_t most_poses_, most_points_;
  double min_flow_;
  mutable std::vector<double> flows_;  // buffer
};

}  // namespace maploop::stereo
