#include "estimators/lidar/lidar_odometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimators/lidar/motion_covariance.h"
#include "estimators/lidar/parameter_table.h"
#include "msgs/archive.h"
#include "msgs/parameter_archive.h"

namespace maploop::lidar {
namespace {

using Eigen::Isometry3d;

constexpr double nominal_interval = 0.1;  // s, one turn of the LiDAR

double angle(const Isometry3d& T) {
  return Eigen::AngleAxisd(T.linear()).angle();
}

void set_pose(const Isometry3d& T_from_to, RelativeMotion* motion) {
  motion->translation = T_from_to.translation();
  motion->rotation = Eigen::Quaterniond(T_from_to.linear()).normalized();
}

const LidarParameters& checked(const LidarParameters& parameters) {
  validate_parameters(parameters);
  return parameters;
}

}  // namespace

LidarOdometry::LidarOdometry(const Isometry3d& T_body_velo, const LidarParameters& parameters,
                             ForEachChunk for_each_chunk, Registration registration)
    : T_body_velo_(T_body_velo),
      parameters_(checked(parameters)),
      for_each_chunk_(std::move(for_each_chunk)),
      preparation_(T_body_velo, parameters),
      map_(parameters),
      gicp_(parameters, for_each_chunk_),
      registration_(std::move(registration)) {
  prepared_.points.reserve(static_cast<std::size_t>(parameters.max_samples));
}

OdometerResult LidarOdometry::process(const LidarScan* scan, const RelativeMotion* visual) {
  return process(view_of(scan), visual);
}

OdometerResult LidarOdometry::process(const std::optional<ScanView>& scan,
                                      const RelativeMotion* visual) {
  OdometerResult result;
  result.lidar.source = OdometrySource::lidar;
  result.lidar.status = OdometryStatus::bad_input;
  if (visual != nullptr) result.odometry = *visual;
  if (visual != nullptr && visual->status == OdometryStatus::bad_input) visual = nullptr;
  const bool seen = visual != nullptr;
  if (seen && !tells_a_pose(*visual)) visual = nullptr;
  if (!scan && visual == nullptr) return result;
  begin(visual != nullptr ? static_cast<const Sample&>(*visual) : *scan, &result.lidar);
  if (!in_order(scan, result.lidar.stamp) || (visual == nullptr && too_late(*scan))) {
    if (!seen) result.odometry = result.lidar;
    return result;
  }

  const Prediction prediction = predict(result.lidar.stamp, visual);
  Isometry3d T_from_to = prediction.T_from_to;
  if (scan) {
    register_scan(*scan, prediction, &result.lidar);
    if (result.lidar.status == OdometryStatus::ok) T_from_to = result.lidar.T_from_to();
  }
  if (!seen || result.lidar.status == OdometryStatus::ok) {
    result.odometry = result.lidar;
  }
  advance(T_from_to, result);
  if (scan) learn(*scan, result.lidar.status);
  return result;
}

// Without any motion, the pose at the stamp of a refused visual one cannot be told.
bool LidarOdometry::tells_a_pose(const RelativeMotion& visual) const {
  if (visual.status == OdometryStatus::ok) return true;
  return twist_ && !after_gap(visual.stamp);
}

bool LidarOdometry::after_gap(Time stamp) const {
  return started_ && to_seconds(stamp - stamp_) > parameters_.max_gap;
}

void LidarOdometry::begin(const Sample& sample, LidarMotion* motion) const {
  static_cast<Sample&>(*motion) = sample;
  if (started_) motion->from = stamp_;
}

// Returns whether the step is in order. After max_stale_scans old stamps the odometry restarts.
bool LidarOdometry::in_order(const std::optional<ScanView>& scan, Time stamp) {
  if (scan && !(scan->start < scan->stamp && scan->stamp < scan->end && scan->start <= stamp &&
                stamp <= scan->end)) {
    return false;
  }
  if (started_ && stamp <= stamp_) {
    if (++stale_ < parameters_.max_stale_scans) return false;
    restart();
    started_ = false;
  }
  stale_ = 0;
  return true;
}

// A scan without visual motion is too late if a step within its turn was already taken: its
// visual motion was processed without it.
bool LidarOdometry::too_late(const ScanView& scan) const {
  return started_ && scan.start < stamp_;
}

void LidarOdometry::restart() {
  map_.clear();
  refused_in_a_row_ = 0;
}

LidarOdometry::Prediction LidarOdometry::predict(Time stamp, const RelativeMotion* visual) {
  Prediction p;
  const double seconds = started_ ? to_seconds(stamp - stamp_) : 0.0;
  if (after_gap(stamp)) {
    restart();
    twist_.reset();
  }
  if (visual != nullptr && visual->status == OdometryStatus::ok) {
    twist_ = Twist::of(visual->T_from_to(), to_seconds(visual->stamp - visual->from));
    const Eigen::Matrix3d R_to_from = visual->rotation.toRotationMatrix().transpose();
    p.visual = true;
    if (seed_covariance_) {
      *seed_covariance_ = carried_over(*seed_covariance_, visual->T_from_to()) +
                          to_from_axes(visual->covariance, R_to_from);
    }
  } else {
    seed_covariance_.reset();
  }
  p.known = p.visual || (twist_ && parameters_.constant_motion);
  if (p.known) p.T_from_to = twist_->over(seconds);
  return p;
}

// Prepares, aligns and judges the scan. On refusal it sets the status and diagnostics only.
void LidarOdometry::register_scan(const ScanView& scan, const Prediction& prediction,
                                  LidarMotion* motion) {
  preparation_.prepare(scan, motion->stamp, twist_.value_or(Twist{}), &prepared_);
  motion->tracked = static_cast<int>(prepared_.points.size());
  if (prediction.visual && !map_is_sharp_) map_.clear();  // this scan can start a sharp map
  if (map_.empty()) {
    motion->status = motion->tracked < parameters_.min_points ? OdometryStatus::too_few_features
                                                              : OdometryStatus::first_frame;
    return;
  }
  const Isometry3d seed = T_map_body_ * prediction.T_from_to;
  const Alignment alignment = registration_ ? registration_(map_, prepared_, seed, prediction.known)
                                            : gicp_.align(map_, prepared_, seed, prediction.known);
  motion->inliers = alignment.partners;
  motion->iterations = alignment.iterations;
  motion->degenerate = alignment.degeneracy.directions;
  motion->status = alignment.status;
  if (alignment.status != OdometryStatus::ok) return;

  const Isometry3d change = seed.inverse() * alignment.T_map_body;
  motion->seed_translation_error = change.translation().norm();
  motion->seed_rotation_error = angle(change);
  const Isometry3d T_from_to = T_map_body_.inverse() * alignment.T_map_body;
  motion->status = judge(T_from_to, prediction, *motion);
  if (motion->status != OdometryStatus::ok) return;
  set_pose(T_from_to, motion);
  motion->source = prediction.visual ? OdometrySource::visual_lidar : OdometrySource::lidar;
  motion->covariance = to_from_axes(covariance(alignment), T_from_to.linear());
}

OdometryStatus LidarOdometry::judge(const Isometry3d& T_from_to, const Prediction& prediction,
                                    const LidarMotion& motion) const {
  const double seconds = to_seconds(motion.stamp - stamp_);
  if (!(T_from_to.translation().norm() <= parameters_.max_speed * seconds) ||
      !(angle(T_from_to) <= parameters_.max_yaw_rate * seconds)) {
    return OdometryStatus::implausible;
  }
  // The seed's errors accumulate from the last scan that was used.
  const double intervals =
      std::max(1.0, to_seconds(motion.stamp - aligned_stamp_) / nominal_interval);
  if (prediction.visual &&
      (motion.seed_translation_error > parameters_.max_disagreement * intervals ||
       motion.seed_rotation_error > parameters_.max_disagreement_rotation * intervals)) {
    return OdometryStatus::disagreement;
  }
  return OdometryStatus::ok;
}

// Combines the points' covariance in directions they determine with the seed's in the others.
Matrix6d LidarOdometry::covariance(const Alignment& alignment) const {
  const Matrix6d unseen = Matrix6d::Identity() - alignment.degeneracy.seen;
  Matrix6d seed = Matrix6d::Identity();  // 1 m, 1 rad: the motion is unknown
  if (seed_covariance_) seed = *seed_covariance_;
  // (8) of METHOD.md
  return parameters_.correlated_points * alignment.covariance + unseen * seed * unseen.transpose();
}

void LidarOdometry::advance(const Isometry3d& T_from_to, const OdometerResult& result) {
  const double seconds = started_ ? to_seconds(result.lidar.stamp - stamp_) : 0.0;
  T_map_body_ = T_map_body_ * T_from_to;
  if (result.lidar.status == OdometryStatus::ok) {
    twist_ = Twist::of(T_from_to, seconds);
    aligned_stamp_ = result.lidar.stamp;
    seed_covariance_ = Matrix6d::Zero();
  }
  stamp_ = result.lidar.stamp;
  started_ = true;
}

// Adds the scan to the map, or starts the map with it.
void LidarOdometry::learn(const ScanView& scan, OdometryStatus status) {
  if (status == OdometryStatus::first_frame) {
    map_.insert(prepared_, T_map_body_);
    map_is_sharp_ = twist_.has_value();
    aligned_stamp_ = stamp_;
    seed_covariance_ = Matrix6d::Zero();
    return;
  }
  if (status != OdometryStatus::ok) {
    if (!map_.empty() && ++refused_in_a_row_ >= parameters_.restart_after) restart();
    return;
  }
  refused_in_a_row_ = 0;
  if (!map_is_sharp_) {
    // The map's only scan was smeared, since its motion was unknown; this scan replaces it.
    preparation_.prepare(scan, stamp_, *twist_, &prepared_);
    map_.clear();
    map_is_sharp_ = true;
  }
  if (parameters_.scan_to_scan) map_.clear();
  map_.insert(prepared_, T_map_body_);
  map_.forget(T_map_body_.translation());
}

// The members that are not archived are buffers of one call.
template <class Archive, class Odometry>
void LidarOdometry::describe(Archive& ar, Odometry& o) {
  ar.section("LiDAR odometry", 3);
  archive_same(ar, "mounting of the LiDAR", o.T_body_velo_);
  archive_same_parameters(ar, o.parameters_);
  ar(o.started_, o.stamp_, o.aligned_stamp_, o.T_map_body_, o.twist_, o.map_is_sharp_,
     o.refused_in_a_row_, o.stale_, o.seed_covariance_, o.map_);
}

void LidarOdometry::archive(ArchiveWriter& ar) const {
  describe(ar, *this);
}

void LidarOdometry::archive(ArchiveReader& ar) {
  LidarOdometry loaded(T_body_velo_, parameters_, for_each_chunk_, registration_);
  describe(ar, loaded);
  *this = std::move(loaded);
}

}  // namespace maploop::lidar
