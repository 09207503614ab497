#include "tools/evaluate/kitti_metric.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace maploop::evaluation {
namespace {

constexpr double common_rotation_length = 25.0;  // m
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

// The general inverse is used like in the devkit, because a rounded pose from a file is not an
// exact rotation.
Eigen::Isometry3d between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  return from.inverse(Eigen::Affine) * to;
}

// Both trajectories over the same frames, relative to their own first pose.
struct Pair {
  Trajectory estimate;
  Trajectory truth;
  std::vector<double> distance;  // along the truth, m
};

Pair aligned(const Trajectory& estimate, const Trajectory& truth) {
  const std::size_t frames = std::min(estimate.size(), truth.size());
  if (frames < 2)
    throw std::invalid_argument("scoring needs two poses of the estimate and of the truth");
  Pair pair;
  for (std::size_t i = 0; i < frames; ++i) {
    pair.estimate.push_back(between(estimate.front(), estimate[i]));
    pair.truth.push_back(between(truth.front(), truth[i]));
  }
  pair.distance = distances(truth);
  pair.distance.resize(frames);
  return pair;
}

// Calls visit(motion of the estimate, motion of the truth) for each segment of `length`; segments
// start at every `every`-th frame.
template <typename Visit>
void for_each_segment(const Pair& pair, double length, std::size_t every, Visit visit) {
  const auto& distance = pair.distance;
  for (std::size_t first = 0; first < distance.size(); first += every) {
    const auto found = std::upper_bound(distance.begin(), distance.end(), distance[first] + length);
    if (found == distance.end()) return;  // later segments would end even later
    const auto last = static_cast<std::size_t>(found - distance.begin());
    visit(between(pair.estimate[first], pair.estimate[last]),
          between(pair.truth[first], pair.truth[last]));
  }
}

double angle_deg(const Eigen::Matrix3d& rotation) {
  const double cosine = std::clamp((rotation.trace() - 1.0) / 2.0, -1.0, 1.0);
  return std::acos(cosine) * 180.0 / std::numbers::pi;
}

class MeanError {
 public:
  void add(const Pair& pair, double length, std::size_t every) {
    for_each_segment(pair, length, every, [&](const auto& estimate, const auto& truth) {
      const Eigen::Isometry3d error = between(estimate, truth);
      percent_ += 100.0 * error.translation().norm() / length;
      deg_per_m_ += angle_deg(error.linear()) / length;
      ++segments_;
    });
  }
  SegmentError mean() const {
    if (segments_ == 0) return {not_a_number, not_a_number, 0};
    return {percent_ / segments_, deg_per_m_ / segments_, segments_};
  }

 private:
  double percent_ = 0.0;
  double deg_per_m_ = 0.0;
  int segments_ = 0;
};

Eigen::Matrix3d fit_rotation(const Pair& pair) {
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  for_each_segment(pair, common_rotation_length, 1, [&](const auto& estimate, const auto& truth) {
    correlation += estimate.translation() * truth.translation().transpose();
  });
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d& u = svd.matrixU();
  const Eigen::Matrix3d& v = svd.matrixV();
  // The last singular direction is reversed if the best orthogonal matrix is a reflection.
  const Eigen::Vector3d sign(1.0, 1.0, (v * u.transpose()).determinant());
  return v * sign.asDiagonal() * u.transpose();
}

}  // namespace

std::vector<double> distances(const Trajectory& trajectory) {
  std::vector<double> along{0.0};
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    along.push_back(along.back() +
                    (trajectory[i].translation() - trajectory[i - 1].translation()).norm());
  return along;
}

Eigen::Matrix3d fit_common_rotation(const Trajectory& estimate, const Trajectory& truth) {
  return fit_rotation(aligned(estimate, truth));
}

Score score(const Trajectory& estimate, const Trajectory& truth, double length_m,
            CommonRotation common_rotation) {
  if (!(length_m > 0.0)) throw std::invalid_argument("the length of a segment must be positive");
  Pair pair = aligned(estimate, truth);
  if (common_rotation == CommonRotation::remove) {
    const Eigen::Isometry3d rotation(fit_rotation(pair));
    for (Eigen::Isometry3d& pose : pair.estimate) pose = rotation * pose * rotation.inverse();
  }
  Score result;
  result.frames = static_cast<int>(pair.truth.size());
  result.distance_m = pair.distance.back();
  result.end_point_m = between(pair.estimate.back(), pair.truth.back()).translation().norm();
  result.end_point_percent =
      result.distance_m > 0.0 ? 100.0 * result.end_point_m / result.distance_m : not_a_number;
  MeanError error;
  error.add(pair, length_m, 1);
  result.segment = error.mean();
  return result;
}

SegmentError kitti_odometry_error(const Trajectory& estimate, const Trajectory& truth) {
  constexpr std::size_t start_every = 10;
  const Pair pair = aligned(estimate, truth);
  MeanError error;
  for (int length = 100; length <= 800; length += 100) error.add(pair, length, start_every);
  return error.mean();
}

}  // namespace maploop::evaluation
