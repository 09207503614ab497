#include "runtime/vehicle/stages/antenna_track.h"

#include <algorithm>
#include <cmath>

#include "msgs/frames.h"
#include "ppp/models/geodesy.h"

namespace maploop::vehicle {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

constexpr Duration longest_without_speed = std::chrono::milliseconds(500);
constexpr Duration longest_step = std::chrono::milliseconds(50);  // from a state to an epoch
constexpr Duration longest_interval = std::chrono::seconds(10);
constexpr double worst_azimuth = 0.1;  // rad, 1 sigma
constexpr double jump = 2.0;           // m, between a displacement and the velocities

bool moved_by_a_sensor(const FusedState& s) {
  const Time newest = std::max({s.odometry_stamp, s.wheel_stamp, s.zero_velocity_stamp});
  return s.odom.status == NavStatus::aided && s.stamp - newest <= longest_without_speed;
}

}  // namespace

void AntennaTrack::add(const FusedState& state) {
  constexpr int azimuth = 6;  // of the covariance
  const double variance = state.covariance(azimuth, azimuth);
  if (!moved_by_a_sensor(state) || variance > worst_azimuth * worst_azimuth) return;
  if (moments_.size() == capacity) moments_.erase(moments_.begin());
  const Matrix3d R_odom_body = rotation_enu_body(state.odom.attitude);
  const Vector3d turning(0.0, 0.0, state.odom.yaw_rate);
  Moment& m = moments_.emplace_back();
  m.stamp = state.stamp;
  m.available = state.available;
  m.origin = state.origin;
  m.place = state.odom.position + R_odom_body * lever_;
  m.velocity = R_odom_body * (state.odom.velocity_body + turning.cross(lever_));
  m.R_enu_odom = rotation_enu_body(state.attitude) * R_odom_body.transpose();
  m.azimuth = state.odom.attitude.azimuth;
  m.azimuth_sigma = std::sqrt(variance);
}

std::optional<AntennaTrack::Moment> AntennaTrack::at(Time stamp, Time available) const {
  const auto before = std::find_if(moments_.rbegin(), moments_.rend(), [&](const Moment& m) {
    return m.stamp <= stamp && m.available <= available;
  });
  if (before == moments_.rend() || stamp - before->stamp > longest_step) return std::nullopt;
  Moment m = *before;
  m.place += to_seconds(stamp - m.stamp) * m.velocity;
  m.stamp = stamp;
  return m;
}

std::optional<ppp::CarriedMotion> AntennaTrack::motion_to(Time stamp, Time available) {
  const std::optional<Moment> from = last_, to = last_ = at(stamp, available);
  std::erase_if(moments_, [&](const Moment& m) { return m.stamp < stamp - longest_step; });
  if (!from || !to || to->stamp - from->stamp > longest_interval || to->stamp <= from->stamp)
    return std::nullopt;
  ppp::CarriedMotion motion;
  motion.interval = to_seconds(to->stamp - from->stamp);
  const Vector3d moved = to->place - from->place;
  const Vector3d by_velocity = 0.5 * motion.interval * (from->velocity + to->velocity);
  if ((moved - by_velocity).norm() > jump * std::max(1.0, motion.interval)) return std::nullopt;
  const Matrix3d R_ecef_odom = ppp::rotation_enu_ecef(to->origin).transpose() * to->R_enu_odom;
  motion.displacement = R_ecef_odom * moved;
  motion.velocity = R_ecef_odom * to->velocity;
  motion.turn_sigma = to->azimuth_sigma;
  motion.lever_sigma = lever_sigma_ * std::abs(wrap_angle(to->azimuth - from->azimuth));
  return motion;
}

}  // namespace maploop::vehicle
