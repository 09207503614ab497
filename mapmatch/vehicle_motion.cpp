#include "mapmatch/vehicle_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

constexpr double acceleration = 1.5;           // m/s^2/sqrt(Hz), of a vehicle with unknown speed
constexpr double good_azimuth = radians(1.0);  // sigma for which `visual_gate` is meant
constexpr double share_memory = 60.0;          // s
constexpr double prior_fixes = 4.0;            // weight of the prior of the white share
constexpr double prior_share = 0.5;
constexpr double floor_variance = 0.25;  // m^2, smallest error of odometry and of the path

Eigen::Vector2d heading(double azimuth) {
  return {std::sin(azimuth), std::cos(azimuth)};
}

}  // namespace

void VehicleMotion::filter_course(const VehicleFix& fix, const Eigen::Vector2d& place,
                                  double interval) {
  if (count_ == 0) {
    course_ << place, 0.0, 0.0;
    course_covariance_ = Eigen::Vector4d(0.0, 0.0, 400.0, 400.0).asDiagonal();
    course_covariance_.topLeftCorner<2, 2>() = fix.covariance;
    return;
  }
  Eigen::Matrix4d F = Eigen::Matrix4d::Identity();
  F(0, 2) = F(1, 3) = interval;
  const double q = acceleration * acceleration;
  Eigen::Matrix4d Q = Eigen::Matrix4d::Zero();
  for (int i = 0; i < 2; ++i) {
    Q(i, i) = q * std::pow(interval, 3) / 3.0;
    Q(i, i + 2) = Q(i + 2, i) = q * interval * interval / 2.0;
    Q(i + 2, i + 2) = q * interval;
  }
  course_ = F * course_;
  course_covariance_ = F * course_covariance_ * F.transpose() + Q;
  // Only the part of the fixes' error that changes from fix to fix disturbs a velocity.
  const double white = std::clamp(jumps_ / expected_, 0.05, 1.0);
  const Eigen::Matrix2d S = course_covariance_.topLeftCorner<2, 2>() + white * fix.covariance +
                            floor_variance * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<double, 4, 2> K = course_covariance_.leftCols<2>() * S.inverse();
  course_ += K * (place - course_.head<2>());
  const Eigen::Matrix4d updated = course_covariance_ - K * course_covariance_.topRows<2>();
  course_covariance_ = 0.5 * (updated + updated.transpose());
}

// Two fixes differ by the path travelled between them and by the change of their errors, whose
// variance is twice theirs for white errors and nearly zero for slow ones.
void VehicleMotion::estimate_white_share(const VehicleFix& fix, const Eigen::Vector2d& jump,
                                         double interval) {
  const double keep = std::exp(-interval / share_memory);
  const double expected = 2.0 * fix.covariance.trace() + 4.0 * floor_variance;  // (1) of METHOD.md
  jumps_ = keep * jumps_ + std::min(jump.squaredNorm(), 9.0 * expected);
  expected_ = keep * expected_ + expected;
}

double VehicleMotion::change(double Moment::*angle, const Moment& now, double seconds) const {
  const Moment* then = nullptr;
  const std::size_t known = std::min(next_, history_length);
  for (std::size_t i = 1; i <= known; ++i) {
    const Moment& m = history_[(next_ - i) % history_length];
    then = &m;
    if (to_seconds(now.stamp - m.stamp) >= seconds - 0.01) break;
  }
  if (!then) return unknown;
  return wrap_angle(now.*angle - then->*angle);
}

bool VehicleMotion::seen_throughout(const Moment& now, double seconds) const {
  if (std::isnan(now.visual_azimuth)) return false;
  const std::size_t known = std::min(next_, history_length);
  for (std::size_t i = 1; i <= known; ++i) {
    const Moment& m = history_[(next_ - i) % history_length];
    if (std::isnan(m.visual_azimuth)) return false;
    if (to_seconds(now.stamp - m.stamp) >= seconds - 0.01) return true;
  }
  return known > 0;
}

// Visual odometry is ignored if it contradicts the fixes over the same second.
void VehicleMotion::add_visual(const VehicleFix& fix, const Moment& now,
                               const MatchParameters& parameters, Motion& motion) const {
  if (!seen_throughout(now, 1.0)) return;
  const double turn = change(&Moment::visual_azimuth, now, 1.0);
  const double difference = wrap_angle(turn - change(&Moment::azimuth, now, 1.0));
  if (std::abs(difference) >=
      parameters.visual_gate * std::max(1.0, motion.azimuth_sigma / good_azimuth))
    return;
  motion.visual_speed = fix.visual_speed;
  motion.visual_turn = std::abs(turn);
  if (seen_throughout(now, 6.0))
    motion.visual_reversal = std::abs(change(&Moment::visual_azimuth, now, 6.0));
}

double VehicleMotion::mean_yaw_rate(const Moment& now) const {
  double sum = now.yaw_rate;
  int count = 1;
  const std::size_t known = std::min(next_, history_length);
  for (std::size_t i = 1; i <= known; ++i) {
    const Moment& m = history_[(next_ - i) % history_length];
    if (to_seconds(now.stamp - m.stamp) >= 1.0 - 0.01) break;
    sum += m.yaw_rate;
    ++count;
  }
  return std::abs(sum / count);
}

Motion VehicleMotion::add(const VehicleFix& fix, const Eigen::Vector2d& place,
                          const MatchParameters& parameters) {
  Motion motion;
  if (count_ == 0) {
    expected_ = prior_fixes * (2.0 * fix.covariance.trace() + 4.0 * floor_variance);
    jumps_ = prior_share * expected_;
  } else {
    motion.interval = to_seconds(fix.stamp - stamp_);
  }
  const bool told = std::isfinite(fix.speed) && std::isfinite(fix.azimuth);
  if (!told) filter_course(fix, place, motion.interval);
  const Eigen::Vector2d velocity = course_.tail<2>();
  const double velocity_sigma =
      std::sqrt(0.5 * course_covariance_.bottomRightCorner<2, 2>().trace());
  // A velocity within its own sigma is noise, and the vehicle may stand.
  const bool moves = velocity.norm() > std::numbers::sqrt2 * velocity_sigma;
  motion.speed = std::isfinite(fix.speed) ? fix.speed : moves ? velocity.norm() : 0.0;
  motion.speed_sigma = std::isfinite(fix.speed) ? fix.speed_sigma : velocity_sigma;
  if (std::isfinite(fix.azimuth)) {
    motion.azimuth = fix.azimuth;
    motion.azimuth_sigma = fix.azimuth_sigma;
  } else if (motion.speed > parameters.min_speed &&
             velocity.norm() > std::max(parameters.min_speed, 2.0 * velocity_sigma)) {
    motion.azimuth = std::atan2(velocity.x(), velocity.y());
    motion.azimuth_sigma = velocity_sigma / velocity.norm();
  }
  if (count_ > 0) {
    const double mean_speed = 0.5 * (speed_ + motion.speed);
    motion.distance = mean_speed * motion.interval;
    double course = motion.azimuth;
    if (std::isfinite(course) && std::isfinite(azimuth_))
      course = azimuth_ + 0.5 * wrap_angle(motion.azimuth - azimuth_);
    if (std::isfinite(course)) {
      motion.step = motion.distance * heading(course);
      estimate_white_share(fix, place - place_ - motion.step, motion.interval);
    }
  }
  motion.white_share = std::clamp(jumps_ / expected_, 0.0, 1.0);

  const Moment now{fix.stamp, motion.azimuth, fix.visual_azimuth, fix.yaw_rate};
  motion.turn = std::abs(change(&Moment::azimuth, now, 1.0));
  motion.reversal = std::abs(change(&Moment::azimuth, now, 6.0));
  add_visual(fix, now, parameters, motion);
  motion.turn_rate = mean_yaw_rate(now);
  if (std::isnan(motion.turn_rate)) motion.turn_rate = motion.turn;  // over one second
  history_[next_ % history_length] = now;
  ++next_;
  ++count_;
  stamp_ = fix.stamp;
  place_ = place;
  speed_ = motion.speed;
  azimuth_ = motion.azimuth;
  return motion;
}

}  // namespace maploop::mapmatch
