#include "tools/evaluate/pose_errors.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "msgs/frames.h"

namespace maploop::evaluation {
namespace {

Eigen::Matrix3Xd positions(const Trajectory& trajectory) {
  Eigen::Matrix3Xd all(3, static_cast<Eigen::Index>(trajectory.size()));
  for (std::size_t i = 0; i < trajectory.size(); ++i)
    all.col(static_cast<Eigen::Index>(i)) = trajectory[i].translation();
  return all;
}

void require_same_length(const Trajectory& estimate, const Trajectory& truth, std::size_t least) {
  if (estimate.size() != truth.size() || estimate.size() < least)
    throw std::invalid_argument("pose errors need " + std::to_string(least) +
                                " poses or more of the estimate, and as many of the truth");
}

}  // namespace

Statistics statistics(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  Statistics s;
  for (const double v : values) {
    s.mean += v;
    s.rmse += v * v;
  }
  const auto count = static_cast<double>(values.size());
  s.mean /= count;
  s.rmse = std::sqrt(s.rmse / count);
  s.median = 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
  s.max = values.back();
  return s;
}

Eigen::Isometry3d best_alignment(const Trajectory& estimate, const Trajectory& truth) {
  require_same_length(estimate, truth, 3);
  return Eigen::Isometry3d(Eigen::umeyama(positions(estimate), positions(truth), false));
}

std::vector<double> absolute_errors(const Trajectory& estimate, const Trajectory& truth,
                                    const Eigen::Isometry3d& alignment) {
  require_same_length(estimate, truth, 1);
  std::vector<double> errors;
  for (std::size_t i = 0; i < truth.size(); ++i)
    errors.push_back((alignment * estimate[i].translation() - truth[i].translation()).norm());
  return errors;
}

RelativeErrors relative_errors(const Trajectory& estimate, const Trajectory& truth) {
  require_same_length(estimate, truth, 2);
  RelativeErrors errors;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Eigen::Isometry3d off =
        (estimate[i - 1].inverse() * estimate[i]).inverse() * (truth[i - 1].inverse() * truth[i]);
    errors.translation_m.push_back(off.translation().norm());
    errors.rotation_deg.push_back(degrees(Eigen::AngleAxisd(off.linear()).angle()));
  }
  return errors;
}

}  // namespace maploop::evaluation
