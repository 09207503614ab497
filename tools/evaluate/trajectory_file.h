// Reads and writes trajectories in common formats: poses of KITTI's odometry benchmark, TUM's,
// recorded truth, RTKLIB's positions, and our own logs.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/local_frame.h"
#include "msgs/time.h"
#include "tools/evaluate/text_lines.h"

namespace maploop::evaluation {

// Poses of the left camera (x right, y down, z forward), metres, one for each frame, all in one
// fixed frame.
using Trajectory = std::vector<Eigen::Isometry3d>;

// `stamps` is empty (if the format has none) or has one for each pose.
struct StampedTrajectory {
  std::vector<Time> stamps;
  Trajectory poses;
  std::optional<Geodetic> origin = {};  // if the fixed frame is east, north, up at a known place
  bool has_attitude = true;             // else each pose is a position, not turned
};

enum class Role { estimate, truth };

// Reads a plain or .gz file; the format is recognized from the contents:
//   KITTI   12 numbers a line, no stamps
//   TUM     stamp x y z qx qy qz qw, seconds; lines that start with # are skipped
//   CSV     recorded truth: a heading with the columns t, cam_x ... cam_z, cam_qw ... cam_qz
//   .pos    RTKLIB's positions, by the file's name; no attitude (rtklib_positions.h)
//   log     an LCM log, or the same in an MCAP file or a bag: TRUTH if it is the truth that is
//           read, else NAV_STATE; of the left camera if there is a CALIBRATION
// Throws std::runtime_error naming file and line if a line does not have the format, a quaternion
// does not have length one (to 1e-3), or the stamps do not increase.
StampedTrajectory read_trajectory(const std::filesystem::path& file, Role role = Role::estimate);

// Reads the last format of those above.
StampedTrajectory read_log_trajectory(const std::filesystem::path& file, Role role);

// Reads KITTI's format: the upper 3x4 of the left camera's pose in row-major order, twelve numbers
// separated by blanks, one line for each frame. Empty lines are skipped. Throws std::runtime_error
// naming the file, and the line of a pose that does not have exactly twelve finite numbers or whose
// left 3x3 block is not a rotation (to 1e-3: files are rounded); also if the file cannot be read or
// contains no pose.
Trajectory read_kitti_poses(const std::filesystem::path& file);

// Reading the file returns bitwise equal numbers. Throws std::runtime_error naming the file if it
// cannot be written, std::invalid_argument if a pose is not finite.
void write_kitti_poses(const std::filesystem::path& file, const Trajectory& trajectory);

// Nanoseconds are kept. Throws std::runtime_error naming the file if it cannot be written.
void write_tum(const std::filesystem::path& file, const StampedTrajectory& trajectory);

// A line of TUM's format as it is: the quaternion may have any length.
struct TumPose {
  Time stamp;
  Eigen::Vector3d place;
  Eigen::Quaterniond rotation;
};
// `words` are those of the line, stamp x y z qx qy qz qw. Fails as TextLines::fail().
TumPose tum_pose(const TextLines& lines, const Cells& words);

// Poses of both trajectories at the same times: their stamps differ by at most `tolerance`, and
// each pose is used once. If one trajectory has no stamps, poses are matched frame by frame.
struct Matched {
  std::vector<Time> stamps;  // the estimate's, or empty
  Trajectory estimate;
  Trajectory truth;
  std::vector<std::size_t> frames = {};                     // of the truth's poses, in its file
  std::size_t unmatched_estimate = 0, unmatched_truth = 0;  // poses without a partner
};
Matched match(const StampedTrajectory& estimate, const StampedTrajectory& truth,
              Duration tolerance);

// Returns the stamp of a matched pose in seconds, to the microsecond, or nothing without stamps.
std::string stamp_text(const Matched& matched, std::size_t pose);

// KITTI's ground truth is OXTS put through a spherical Mercator projection: at 49 degrees north its
// metres are 0.19 % short from east to west and 0.10 % long from north to south. Returns positions
// relative to the first pose in metres of WGS84, for a first camera that looks level to `azimuth`
// (rad, clockwise from north) at `latitude` (rad). The change of the projection along a drive is
// not corrected; it is 2e-5 in a kilometre.
Trajectory from_kitti_mercator(const Trajectory& poses, double latitude, double azimuth);

}  // namespace maploop::evaluation
