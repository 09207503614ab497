#include "tools/evaluate/run_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "msgs/frames.h"

namespace maploop::evaluation {
namespace {

constexpr double kmh = 3.6;  // of m/s

// The poses before and after pose i by a quarter of a second, or the next ones.
std::pair<std::size_t, std::size_t> around(const std::vector<double>& time, std::size_t i) {
  constexpr double half = 0.25;  // s
  const auto at = [&](auto found) { return static_cast<std::size_t>(found - time.begin()); };
  const std::size_t after = at(std::lower_bound(time.begin(), time.end(), time[i] + half));
  const std::size_t before = at(std::upper_bound(time.begin(), time.end(), time[i] - half));
  return {before == 0 ? 0 : before - 1, std::min(after, time.size() - 1)};
}

Eigen::Vector3d level(const Eigen::Vector3d& v, const Eigen::Vector3d& up) {
  return v - up.dot(v) * up;
}

// Returns the angle about the vertical from pose a over i to b, rad. Positions alone show it only
// where they move; elsewhere it is not a number, and in no bin.
double turn(const TruthTrack& truth, std::size_t a, std::size_t i, std::size_t b) {
  const Trajectory& poses = truth.trajectory.poses;
  if (truth.trajectory.has_attitude) {
    const Eigen::AngleAxisd turned(poses[b].linear() * poses[a].linear().transpose());
    return turned.angle() * turned.axis().dot(truth.up);
  }
  constexpr double least = 0.3;  // m
  const Eigen::Vector3d from = level(poses[i].translation() - poses[a].translation(), truth.up);
  const Eigen::Vector3d to = level(poses[b].translation() - poses[i].translation(), truth.up);
  if (from.norm() < least || to.norm() < least) return std::numeric_limits<double>::quiet_NaN();
  return 2.0 * std::atan2(truth.up.dot(from.cross(to)), from.dot(to));
}

void add_motion(TruthTrack& truth) {
  const Trajectory& poses = truth.trajectory.poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto [a, b] = around(truth.time, i);
    const double seconds = truth.time[b] - truth.time[a];
    truth.speed.push_back((poses[b].translation() - poses[a].translation()).norm() / seconds);
    truth.turn_rate.push_back(degrees(std::abs(turn(truth, a, i, b))) / seconds);
  }
}

// Bins without a pose are left out.
std::vector<ErrorBin> binned(const RunErrors& run, const std::vector<double>& of_truth, double unit,
                             const std::vector<double>& edges) {
  std::vector<ErrorBin> bins;
  if (of_truth.empty()) return bins;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const double high = k + 1 < edges.size() ? edges[k + 1] : std::numeric_limits<double>::max();
    std::vector<double> errors;
    for (std::size_t i = 0; i < run.absolute.size(); ++i) {
      const double value = unit * of_truth[run.matched.frames[i]];
      if (value >= edges[k] && value < high) errors.push_back(run.absolute[i]);
    }
    const std::size_t poses = errors.size();
    if (poses > 0) bins.push_back({edges[k], high, statistics(std::move(errors)), poses});
  }
  return bins;
}

void add_absolute(RunErrors& run, const Eigen::Vector3d& up) {
  std::vector<double> heights;
  for (std::size_t i = 0; i < run.matched.truth.size(); ++i) {
    const Eigen::Vector3d error =
        run.matched.estimate[i].translation() - run.matched.truth[i].translation();
    run.vertical.push_back(up.dot(error));
    run.horizontal.push_back(level(error, up).norm());
    run.absolute.push_back(error.norm());
    heights.push_back(std::abs(run.vertical.back()));
  }
  run.horizontal_m = statistics(run.horizontal);
  run.vertical_m = statistics(heights);
  run.absolute_m = statistics(run.absolute);
  run.end_point_m = run.absolute.back();
}

}  // namespace

TruthTrack truth_track(std::string name, StampedTrajectory trajectory) {
  if (trajectory.poses.size() < 3) {
    throw std::runtime_error(name + " has " + std::to_string(trajectory.poses.size()) +
                             " poses, and a truth needs three");
  }
  TruthTrack truth{std::move(name), std::move(trajectory), {}, {}, {}, {}, {}};
  truth.up = vertical_of(truth.trajectory);
  truth.way = distances(truth.trajectory.poses);
  const auto& stamps = truth.trajectory.stamps;
  for (std::size_t i = 0; i < truth.way.size(); ++i) {
    truth.time.push_back(stamps.empty() ? static_cast<double>(i)
                                        : to_seconds(stamps[i] - stamps.front()));
  }
  if (!stamps.empty()) add_motion(truth);
  return truth;
}

void add_run(Comparison& comparison, std::string name, Matched matched, bool has_attitude) {
  const TruthTrack& truth = comparison.truth;
  RunErrors run;
  run.name = std::move(name);
  run.matched = std::move(matched);
  run.has_attitude = has_attitude && truth.trajectory.has_attitude;
  Matched& m = run.matched;
  const Alignment move = alignment(comparison.align, m, truth.up, run.has_attitude);
  run.scale = move.scale;
  for (Eigen::Isometry3d& pose : m.estimate) pose = move(pose);
  if (!run.has_attitude) {
    for (Trajectory* poses : {&m.estimate, &m.truth})
      for (Eigen::Isometry3d& pose : *poses) pose.linear().setIdentity();
  }
  add_absolute(run, truth.up);
  run.kitti = kitti_odometry_error(m.estimate, m.truth);
  for (const double length : comparison.lengths_m)
    run.relative.push_back(score(m.estimate, m.truth, length).segment);
  run.distance_m = distances(m.truth).back();
  run.by_speed = binned(run, truth.speed, kmh, {0, 2, 10, 20, 30, 50, 70, 100, 130});
  run.by_turn_rate = binned(run, truth.turn_rate, 1.0, {0, 1, 2, 5, 10, 20, 40});
  comparison.runs.push_back(std::move(run));
}

}  // namespace maploop::evaluation
