#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/evaluate/trajectory_file.h"
#include "tools/match/track_file.h"

namespace maploop::match {
namespace {

constexpr double stride = 2.0;     // m, distance whose direction is compared with the axes
constexpr double agreement = 0.9;  // least mean cosine between an axis and the direction of motion

struct Pose {
  Eigen::Vector2d place;
  Eigen::Matrix3d rotation;
};

// The format does not define which axis points forward: x for a vehicle, z for a camera. Returns
// the index of the axis that points along the motion, or -1 if there is none.
int forward_axis(const std::vector<Pose>& poses) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double strides = 0.0;
  std::size_t last = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Eigen::Vector2d way = poses[i].place - poses[last].place;
    if (way.norm() < stride) continue;
    const std::size_t between = (last + i) / 2;
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] += way.normalized().dot(poses[between].rotation.col(axis).head<2>());
    strides += 1.0;
    last = i;
  }
  int best = 0;
  if (strides == 0.0 || sum.maxCoeff(&best) < agreement * strides) return -1;
  return best;
}

}  // namespace

Track parse_tum_track(std::string_view text, std::string_view name, const TrackOptions& options) {
  if (!options.origin)
    throw std::runtime_error(std::string(name) +
                             " is in local metres: say where their origin is (--origin LAT,LON)");
  const LocalFrame frame(*options.origin);
  Track track;
  std::vector<Pose> poses;
  for (evaluation::TextLines lines(text, std::string(name)); lines.next();) {
    const evaluation::Cells words = lines.words();
    if (words.size() != 8) lines.fail("not 't x y z qx qy qz qw'");
    const evaluation::TumPose pose = evaluation::tum_pose(lines, words);
    mapmatch::VehicleFix fix;
    fix.stamp = pose.stamp;
    fix.position = frame.to_geodetic({pose.place.x(), pose.place.y(), 0.0});
    fix.covariance = options.sigma * options.sigma * Eigen::Matrix2d::Identity();
    keep(fix, name, track);
    poses.push_back({pose.place.head<2>(), pose.rotation.normalized().toRotationMatrix()});
  }
  if (const int axis = forward_axis(poses); axis >= 0) {
    for (std::size_t i = 0; i < track.size(); ++i) {
      const Eigen::Vector3d forward = poses[i].rotation.col(axis);
      track[i].azimuth = std::atan2(forward.x(), forward.y());
    }
  }
  return track;
}

}  // namespace maploop::match
