#include "sensors/imu/mount_alignment.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "msgs/frames.h"

namespace maploop::sensors {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t samples_kept = 1024;
constexpr double longest_step = 0.1;  // s between two samples of which a mean can be made
// These bound the time between two fixes, s: over a shorter one the noise of the velocities hides
// the acceleration, and over a longer one the vehicle turns too far.
constexpr double shortest_interval = 0.4, longest_interval = 1.5;

constexpr double gravity = 9.81;         // m/s^2; a unit's own scale is off by more than its change
constexpr double rest_speed = 0.3;       // m/s
constexpr double rest_rate = 0.01;       // rad/s, of a vehicle that is not being entered or left
constexpr double enough_rest = 2.0;      // s
constexpr double rest_memory = 60.0;     // s
constexpr double course_speed = 3.0;     // m/s, below which a course says little of the azimuth
constexpr double worst_velocity = 1.0;   // m/s, 1 sigma a horizontal axis
constexpr double force_gate = 1.5;       // m/s^2, between the lengths of both forces
constexpr double most_horizontal = 8.0;  // m/s^2, what tyres hold
constexpr double rate_gate = 0.2;       // rad/s, between the turning of the gyros and of the course
constexpr double robust_force = 0.5;    // m/s^2, residual at which an interval has half its weight
constexpr double least_residual = 0.1;  // m/s^2, of velocities that are good to 0.03 m/s
constexpr double found_sigma = radians(1.0);
constexpr std::uint64_t least_intervals = 20;

Matrix3d rotation(const MountParameters& p) {
  return (Eigen::AngleAxisd(radians(p.yaw), Vector3d::UnitZ()) *
          Eigen::AngleAxisd(radians(p.pitch), Vector3d::UnitY()) *
          Eigen::AngleAxisd(radians(p.roll), Vector3d::UnitX()))
      .toRotationMatrix();
}

// Returns the rotation R for which sum w |a - R b|^2 is least, of the sum of w a b^T.
Matrix3d closest_rotation(const Matrix3d& profile) {
  const Eigen::JacobiSVD<Matrix3d> svd(profile, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3d& U = svd.matrixU();
  const Matrix3d& V = svd.matrixV();
  const Vector3d signs(1.0, 1.0, U.determinant() * V.determinant() < 0.0 ? -1.0 : 1.0);
  return U * signs.asDiagonal() * V.transpose();
}

double yaw_of(const Vector3d& velocity_enu) {
  return std::atan2(velocity_enu.y(), velocity_enu.x());
}

double horizontal_speed(const GnssFix& fix) {
  return fix.velocity_enu.head<2>().norm();
}

double velocity_sigma(const GnssFix& fix) {
  return std::sqrt(std::max(0.0, fix.velocity_covariance.diagonal().head<2>().maxCoeff()));
}

}  // namespace

// This is what the unit and the receiver say of one interval.
struct MountAlignment::Motion {
  Vector3d rate, force;      // means, in the unit's axes
  Vector3d body_force;       // m/s^2, from the receiver
  double course_rate = 0.0;  // rad/s, to the left

  Motion(const Values& mean, const GnssFix& a, const GnssFix& b, double duration, double axle)
      : rate(mean.head<3>()), force(mean.segment<3>(3)) {
    const Vector3d velocity = 0.5 * (a.velocity_enu + b.velocity_enu);
    const double turn = wrap_angle(yaw_of(b.velocity_enu) - yaw_of(a.velocity_enu));
    const double speed = 0.5 * (horizontal_speed(a) + horizontal_speed(b));
    course_rate = turn / duration;
    const double body_yaw =
        yaw_of(a.velocity_enu) + 0.5 * turn - std::atan(axle * course_rate / speed);
    const Attitude attitude{azimuth_from_yaw(body_yaw), std::atan2(velocity.z(), speed), 0.0};
    const Vector3d acceleration = (b.velocity_enu - a.velocity_enu) / duration;
    body_force =
        rotation_enu_body(attitude).transpose() * (acceleration + gravity * Vector3d::UnitZ());
  }

  // A wrong velocity contradicts the unit in ways that do not depend on the mount.
  bool plausible(const Vector3d& gyro_bias) const {
    return std::abs(body_force.norm() - force.norm()) < force_gate &&
           body_force.head<2>().norm() < most_horizontal &&
           std::abs((rate - gyro_bias).norm() - std::abs(course_rate)) < rate_gate;
  }
};

MountAlignment::MountAlignment(const MountParameters& parameters, double rear_axle_distance)
    : rear_axle_distance_(rear_axle_distance), ring_(samples_kept) {
  if (!parameters.given) return;
  mount_.status = MountStatus::given;
  mount_.R_body_unit = rotation(parameters);
  mount_.level_sigma = mount_.forward_sigma = 0.0;
}

void MountAlignment::add(const SixAxisSample& sample) {
  Entry next;
  next.stamp = sample.stamp;
  next.value << sample.rate, sample.force, sample.rate.squaredNorm();
  if (count_ > 0) {
    const Entry& last = entry(count_ - 1);
    const double step = to_seconds(sample.stamp - last.stamp);
    if (step <= 0.0) return;
    if (step > longest_step) {
      count_ = 0;  // no mean reaches across a gap
    } else {
      next.integral = last.integral + 0.5 * step * (last.value + next.value);
    }
  }
  if (count_ == ring_.size()) {
    first_ = (first_ + 1) % ring_.size();
    --count_;
  }
  ring_[(first_ + count_++) % ring_.size()] = next;
  take_pending();
}

void MountAlignment::add(const GnssFix& fix) {
  pending_ = fix;
  take_pending();
}

// The samples up to the fix may come after it.
void MountAlignment::take_pending() {
  if (!pending_ || count_ == 0 || entry(count_ - 1).stamp < pending_->velocity_stamp) return;
  const GnssFix fix = *pending_;
  pending_.reset();
  if (!fix.velocity_enu.allFinite() || !fix.velocity_covariance.allFinite()) return;
  if (!(velocity_sigma(fix) < worst_velocity)) return;
  if (previous_) {
    const double interval = to_seconds(fix.velocity_stamp - previous_->velocity_stamp);
    if (interval < shortest_interval) return;
    if (interval <= longest_interval) learn(*previous_, fix);
  }
  previous_ = fix;
}

std::optional<MountAlignment::Values> MountAlignment::integral_at(Time t) const {
  if (count_ < 2 || t < entry(0).stamp || t > entry(count_ - 1).stamp) return std::nullopt;
  std::size_t low = 0, high = count_ - 1;  // entry(low).stamp <= t <= entry(high).stamp
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (entry(middle).stamp <= t ? low : high) = middle;
  }
  const Entry &a = entry(low), &b = entry(high);
  const double part = to_seconds(t - a.stamp);
  const double share = part / to_seconds(b.stamp - a.stamp);
  return a.integral + part * (a.value + 0.5 * share * (b.value - a.value));
}

void MountAlignment::learn(const GnssFix& a, const GnssFix& b) {
  const auto begin = integral_at(a.velocity_stamp), end = integral_at(b.velocity_stamp);
  if (!begin || !end) return;
  const double duration = to_seconds(b.velocity_stamp - a.velocity_stamp);
  const Values mean = (*end - *begin) / duration;
  const auto [slow, fast] = std::minmax({horizontal_speed(a), horizontal_speed(b)});
  if (fast < rest_speed) {
    learn_rest(mean, duration);
  } else if (slow > course_speed) {
    const Motion motion(mean, a, b, duration, rear_axle_distance_);
    if (motion.plausible(mount_.gyro_bias)) learn_motion(motion);
  }
}

void MountAlignment::learn_rest(const Values& mean, double duration) {
  const bool settled =
      mount_.status == MountStatus::found || (mount_.known() && mount_.intervals > 0);
  const double variance = mean[6] - mean.head<3>().squaredNorm();
  if (settled || variance > rest_rate * rest_rate) return;
  rest_ += duration;
  mount_.gyro_bias += duration / std::min(rest_, rest_memory) * (mean.head<3>() - mount_.gyro_bias);
}

void MountAlignment::learn_motion(const Motion& motion) {
  ++mount_.intervals;
  if (mount_.status == MountStatus::given) return;
  const auto residual = [&] {
    return Vector3d(motion.body_force - mount_.R_body_unit * motion.force);
  };
  const double weight =
      mount_.known() ? 1.0 / (1.0 + residual().squaredNorm() / (robust_force * robust_force)) : 1.0;
  profile_ += weight * motion.body_force * motion.force.transpose();
  turning_.add(motion.rate, motion.course_rate, weight);
  mount_.turning = turning_.line();
  mount_.R_body_unit = closest_rotation(profile_);

  weights_ += weight;
  residuals_ += 0.5 * weight * residual().head<2>().squaredNorm();
  horizontal_ += weight * motion.body_force.head<2>().squaredNorm();
  // The noise of the velocities looks like accelerations, which show no direction.
  const double sigma = std::max(least_residual, std::sqrt(residuals_ / weights_));
  const double seen = std::max(1e-9, horizontal_ - 2.0 * sigma * sigma * weights_);
  mount_.level_sigma = sigma / (gravity * std::sqrt(weights_));
  mount_.forward_sigma = sigma / std::sqrt(seen);
  if (!mount_.known() && mount_.intervals >= least_intervals &&
      mount_.forward_sigma < found_sigma) {
    settle();
  }
}

void MountAlignment::settle() {
  mount_.status = MountStatus::found;
  if (rest_ >= enough_rest) return;
  mount_.gyro_bias = turning_.bias(mount_.R_body_unit.row(2).transpose());
}

ImuSample MountAlignment::aligned(const SixAxisSample& sample) const {
  const Vector3d force = mount_.R_body_unit * sample.force;
  const Vector3d rate = mount_.R_body_unit * (sample.rate - mount_.gyro_bias);
  ImuSample result;
  static_cast<Sample&>(result) = sample;
  result.values() = {force.x(), force.y(), rate.z(), true, force.z(), rate.x(), rate.y()};
  return result;
}

}  // namespace maploop::sensors
