#include "sensors/replay/pose_odometry.h"

#include <stdexcept>
#include <utility>

#include "msgs/frames.h"
#include "sensors/replay/files.h"

namespace maploop::sensors {
namespace {

void add_line(std::string_view line, CameraPoses& all) {
  const std::vector<double> numbers = parse_numbers(line);
  if (numbers.size() != 12 && numbers.size() != 13) {
    throw std::invalid_argument(
        "a pose must have 12 numbers (3x4, row by row), or 13 with the frame's first; this line "
        "has " +
        std::to_string(numbers.size()));
  }
  std::size_t frame = all.frames.size();
  if (numbers.size() == 13) {
    if (!(numbers[0] >= 0.0 && numbers[0] < 1e9))
      throw std::invalid_argument("the first column is not a frame number");
    frame = static_cast<std::size_t>(numbers[0]);
  }
  if (!all.frames.empty() && frame <= all.frames.back())
    throw std::invalid_argument("frame " + std::to_string(frame) + " comes after frame " +
                                std::to_string(all.frames.back()));
  all.poses.push_back(camera_pose(numbers.data() + numbers.size() - 12));
  all.frames.push_back(frame);
}

// The motion of the body between two poses of the camera.
void describe(const Eigen::Isometry3d& T_body_cam, const Eigen::Isometry3d& before,
              const Eigen::Isometry3d& now, const PoseOdometryParameters& parameters,
              RelativeMotion& motion) {
  motion.status = OdometryStatus::ok;
  const Eigen::Isometry3d T = T_body_cam * before.inverse() * now * T_body_cam.inverse();
  motion.translation = T.translation();
  motion.rotation = Eigen::Quaterniond(T.linear()).normalized();
  const double translation_sigma = parameters.speed_sigma * to_seconds(motion.stamp - motion.from);
  const double rotation_sigma = radians(parameters.rotation_sigma);
  motion.covariance.diagonal().head<3>().setConstant(translation_sigma * translation_sigma);
  motion.covariance.diagonal().tail<3>().setConstant(rotation_sigma * rotation_sigma);
}

}  // namespace

Eigen::Isometry3d camera_pose(const double* numbers) {
  constexpr double tolerance = 1e-3;  // numbers in files are rounded
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.affine() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(numbers);
  const Eigen::Matrix3d off =
      pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity();
  if (off.cwiseAbs().maxCoeff() > tolerance || pose.linear().determinant() < 0.0)
    throw std::invalid_argument("the left 3x3 block is not a rotation matrix");
  return pose;
}

CameraPoses read_camera_poses(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  CameraPoses all;
  int number = 0;
  for (const std::string_view line : split_lines(text)) {
    ++number;
    try {
      add_line(line, all);
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": " + e.what());
    }
  }
  if (all.poses.size() < 2)
    throw std::runtime_error(file.string() + ": has fewer than two poses, but a motion needs two");
  return all;
}

std::unique_ptr<Source<RelativeMotion>> make_pose_odometry(std::shared_ptr<const CameraPoses> poses,
                                                           std::vector<Time> stamps,
                                                           const Eigen::Isometry3d& T_body_cam,
                                                           const PoseOdometryParameters& parameters,
                                                           Duration delay) {
  if (poses->frames.back() >= stamps.size()) {
    throw std::runtime_error(parameters.file + ": frame " + std::to_string(poses->frames.back()) +
                             " is beyond the recording's " + std::to_string(stamps.size()));
  }
  return made<RelativeMotion>(
      [poses = std::move(poses), stamps = std::move(stamps), T_body_cam, parameters, delay,
       next = std::size_t{0}](RelativeMotion& motion, SourceReport&) mutable {
        if (next == poses->frames.size()) return false;
        motion = {};
        const std::size_t frame = poses->frames[next];
        motion.stamp = stamps[frame];
        motion.available = motion.stamp + delay;
        motion.sequence = frame;
        if (next > 0) {
          motion.from = stamps[poses->frames[next - 1]];
          describe(T_body_cam, poses->poses[next - 1], poses->poses[next], parameters, motion);
        }
        ++next;
        return true;
      });
}

}  // namespace maploop::sensors
