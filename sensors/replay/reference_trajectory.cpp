#include "sensors/replay/reference_trajectory.h"

#include <algorithm>
#include <stdexcept>

#include "msgs/frames.h"

namespace maploop::sensors {

std::vector<ReferencePose> read_rows(const std::unique_ptr<Source<ReferencePose>>& reference) {
  std::vector<ReferencePose> rows;
  for (ReferencePose row; reference != nullptr && reference->next(row);) rows.push_back(row);
  return rows;
}

ReferenceTrajectory::ReferenceTrajectory(const std::vector<ReferencePose>& rows,
                                         const LocalFrame& frame,
                                         const ReferenceTrajectoryParameters& parameters)
    : max_extrapolation_(from_seconds(parameters.max_extrapolation)),
      max_gap_(from_seconds(parameters.max_gap)) {
  rows_.reserve(rows.size());
  for (const ReferencePose& row : rows) {
    add({row.stamp, frame.to_enu(row.position), Eigen::Quaterniond(rotation_enu_body(row.attitude)),
         row.position_accuracy});
  }
  check_size();
}

ReferenceTrajectory::ReferenceTrajectory(const std::vector<Time>& stamps,
                                         const std::vector<Eigen::Isometry3d>& poses,
                                         const ReferenceTrajectoryParameters& parameters)
    : max_extrapolation_(from_seconds(parameters.max_extrapolation)),
      max_gap_(from_seconds(parameters.max_gap)) {
  rows_.reserve(poses.size());
  for (std::size_t i = 0; i < std::min(stamps.size(), poses.size()); ++i)
    add({stamps[i], poses[i].translation(), Eigen::Quaterniond(poses[i].linear()), 0.0});
  check_size();
}

void ReferenceTrajectory::add(const Row& row) {
  if (!rows_.empty() && row.stamp <= rows_.back().stamp) {
    throw std::invalid_argument("reference trajectory: time does not increase at " +
                                format_time(row.stamp));
  }
  rows_.push_back(row);
}

void ReferenceTrajectory::check_size() const {
  if (rows_.size() >= 2) return;
  throw std::invalid_argument("reference trajectory: needs at least two rows, has " +
                              std::to_string(rows_.size()));
}

const ReferenceTrajectory::Row& ReferenceTrajectory::row_after(Time stamp) const {
  return *std::lower_bound(rows_.begin() + 1, rows_.end() - 1, stamp,
                           [](const Row& row, Time t) { return row.stamp < t; });
}

double ReferenceTrajectory::accuracy(Time stamp) const {
  const Row& b = row_after(stamp);
  if (stamp == b.stamp) return b.accuracy;
  const Row& a = *(&b - 1);
  return stamp == a.stamp ? a.accuracy : std::max(a.accuracy, b.accuracy);
}

std::optional<Eigen::Isometry3d> ReferenceTrajectory::pose(Time stamp) const {
  if (stamp < rows_.front().stamp - max_extrapolation_ ||
      stamp > rows_.back().stamp + max_extrapolation_) {
    return std::nullopt;
  }
  const Row& b = row_after(stamp);
  const Row& a = *(&b - 1);
  if (stamp == b.stamp) return Eigen::Translation3d(b.p_enu) * b.q_enu_body;
  if (stamp == a.stamp) return Eigen::Translation3d(a.p_enu) * a.q_enu_body;
  if (b.stamp - a.stamp > max_gap_) return std::nullopt;

  const double fraction = to_seconds(stamp - a.stamp) / to_seconds(b.stamp - a.stamp);
  Eigen::AngleAxisd turn(a.q_enu_body.conjugate() * b.q_enu_body);
  turn.angle() = fraction * wrap_angle(turn.angle());
  return Eigen::Translation3d(a.p_enu + fraction * (b.p_enu - a.p_enu)) *
         (a.q_enu_body * Eigen::Quaterniond(turn));
}

}  // namespace maploop::sensors
