// Moves an estimated trajectory onto the truth before their positions are compared.
#pragma once

#include <cstdint>

#include "msgs/named_enum.h"
#include "tools/evaluate/trajectory_file.h"

namespace maploop::evaluation {

enum class Align : std::uint8_t {
  none,    // both are in one frame
  origin,  // both start at one pose
  yaw,     // best rotation about the vertical, and translation
  se3,     // best rotation and translation
  sim3,    // the same, and best scale
};

constexpr auto names_of(Align) {
  return names_up_to<Align::sim3>({"none", "origin", "yaw", "se3", "sim3"});
}

struct Alignment {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  double scale = 1.0;  // before the motion

  Eigen::Isometry3d operator()(Eigen::Isometry3d pose) const;
};

// "Best" is least squares of the positions (Umeyama 1991). `up` is the vertical in the truth's
// frame. Without attitude the origin is the first position alone. Throws std::invalid_argument
// unless three poses or more match.
Alignment alignment(Align how, const Matched& matched, const Eigen::Vector3d& up,
                    bool has_attitude = true);

// Returns the rigid motion that brings the estimate's positions nearest to the truth's (Umeyama
// 1991, no scale). Throws std::invalid_argument unless both have the same length of at least three
// poses.
Eigen::Isometry3d best_alignment(const Trajectory& estimate, const Trajectory& truth);

// Returns the vertical in the trajectory's frame: where the left camera's up is in the mean, or z
// without attitude.
Eigen::Vector3d vertical_of(const StampedTrajectory& trajectory);

// Returns the trajectory in the frame at `origin` if it knows its own place. The axes of both
// frames are taken to be parallel, which costs 1e-5 in a distance of 60 m between them.
StampedTrajectory in_frame_at(StampedTrajectory trajectory, const std::optional<Geodetic>& origin);

}  // namespace maploop::evaluation
