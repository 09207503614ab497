#include "msgs/lcm/conversions.h"

#include <cmath>
#include <limits>

#include "msgs/lcm/conversion_parts.h"

namespace maploop {
namespace {

maploop_lcm::thread_health_t to_lcm(const ThreadHealth& t) {
  maploop_lcm::thread_health_t m{};
  m.name = t.name;
  m.scheduling = t.scheduling;
  m.count = static_cast<std::int64_t>(t.count);
  m.rate_hz = t.rate;
  m.failure = t.failure;
  m.cpu_s = t.cpu;
  m.left_out = static_cast<std::int64_t>(t.left_out);
  m.shed = static_cast<std::int64_t>(t.shed);
  return m;
}

ThreadHealth from_lcm(const maploop_lcm::thread_health_t& m) {
  return {m.name,
          m.scheduling,
          static_cast<std::uint64_t>(m.count),
          m.rate_hz,
          m.failure,
          m.cpu_s,
          static_cast<std::uint64_t>(m.left_out),
          static_cast<std::uint64_t>(m.shed)};
}

maploop_lcm::ring_health_t to_lcm(const RingHealth& r) {
  maploop_lcm::ring_health_t m{};
  m.name = r.name;
  m.pushed = static_cast<std::int64_t>(r.pushed);
  m.popped = static_cast<std::int64_t>(r.popped);
  m.lost = static_cast<std::int64_t>(r.lost);
  m.held = static_cast<std::int64_t>(r.held);
  m.capacity = static_cast<std::int64_t>(r.capacity);
  return m;
}

RingHealth from_lcm(const maploop_lcm::ring_health_t& m) {
  return {m.name,
          static_cast<std::uint64_t>(m.pushed),
          static_cast<std::uint64_t>(m.popped),
          static_cast<std::uint64_t>(m.lost),
          static_cast<std::uint64_t>(m.held),
          static_cast<std::uint64_t>(m.capacity)};
}

maploop_lcm::refusal_count_t to_lcm(const RefusalCount& r) {
  maploop_lcm::refusal_count_t m{};
  m.stage = r.stage;
  m.reason = r.reason;
  m.count = static_cast<std::int64_t>(r.count);
  return m;
}

RefusalCount from_lcm(const maploop_lcm::refusal_count_t& m) {
  return {m.stage, m.reason, static_cast<std::uint64_t>(m.count)};
}

maploop_lcm::output_health_t to_lcm(const OutputHealth& o) {
  maploop_lcm::output_health_t m{};
  m.name = o.name;
  m.sent = static_cast<std::int64_t>(o.sent);
  m.unsent = static_cast<std::int64_t>(o.unsent);
  return m;
}

OutputHealth from_lcm(const maploop_lcm::output_health_t& m) {
  return {m.name, static_cast<std::uint64_t>(m.sent), static_cast<std::uint64_t>(m.unsent)};
}

maploop_lcm::sensor_health_t to_lcm(const SensorHealth& s) {
  maploop_lcm::sensor_health_t m{};
  m.name = s.name;
  m.endpoint = s.endpoint;
  m.connected = s.connected ? 1 : 0;
  m.connections = static_cast<std::int64_t>(s.connections);
  m.delivered = static_cast<std::int64_t>(s.delivered);
  m.refused = static_cast<std::int64_t>(s.refused);
  m.problem = s.problem;
  m.clock_known = s.clock.known ? 1 : 0;
  m.utc_ahead_s =
      s.clock.utc_ahead ? to_seconds(*s.clock.utc_ahead) : std::numeric_limits<double>::quiet_NaN();
  m.clock_drift = s.clock.drift;
  m.clock_delay_s = to_seconds(s.clock.delay);
  m.clock_jumps = static_cast<std::int64_t>(s.clock.jumps);
  return m;
}

SensorHealth from_lcm(const maploop_lcm::sensor_health_t& m) {
  SensorHealth s;
  s.name = m.name;
  s.endpoint = m.endpoint;
  s.connected = m.connected != 0;
  s.connections = static_cast<std::uint64_t>(m.connections);
  s.delivered = static_cast<std::uint64_t>(m.delivered);
  s.refused = static_cast<std::uint64_t>(m.refused);
  s.problem = m.problem;
  s.clock.known = m.clock_known != 0;
  if (std::isfinite(m.utc_ahead_s)) s.clock.utc_ahead = from_seconds(m.utc_ahead_s);
  s.clock.drift = m.clock_drift;
  s.clock.delay = from_seconds(m.clock_delay_s);
  s.clock.jumps = static_cast<std::uint64_t>(m.clock_jumps);
  return s;
}

maploop_lcm::realtime_setting_t to_lcm(const RealtimeSetting& s) {
  maploop_lcm::realtime_setting_t m{};
  m.name = s.name;
  m.asked = s.asked;
  m.granted = s.granted;
  m.verdict = static_cast<std::int8_t>(s.verdict);
  m.reason = s.reason;
  m.remedy = s.remedy;
  return m;
}

RealtimeSetting from_lcm(const maploop_lcm::realtime_setting_t& m) {
  return {m.name,    m.asked,
          m.granted, enumerator_from(m.verdict, Verdict::unknown, "realtime_setting_t.verdict"),
          m.reason,  m.remedy};
}

}  // namespace

maploop_lcm::nav_state_t to_lcm(const NavState& state) {
  maploop_lcm::nav_state_t m{};
  m.header = header_of(state);
  m.status = static_cast<std::int8_t>(state.status);
  m.origin_latitude = state.origin.latitude;
  m.origin_longitude = state.origin.longitude;
  m.origin_height = state.origin.height;
  write<3>(state.position_enu, m.position_enu);
  write<3>(state.velocity_enu, m.velocity_enu);
  m.azimuth = state.attitude.azimuth;
  m.pitch = state.attitude.pitch;
  m.roll = state.attitude.roll;
  m.forward_speed = state.forward_speed;
  m.gyro_bias = state.gyro_bias;
  write<9>(state.covariance, m.covariance);
  m.imu_stamp_ns = to_nanoseconds(state.imu_stamp);
  m.odometry_stamp_ns = to_nanoseconds(state.odometry_stamp);
  m.gnss_stamp_ns = to_nanoseconds(state.gnss_stamp);
  m.wheel_stamp_ns = to_nanoseconds(state.wheel_stamp);
  m.zero_velocity_stamp_ns = to_nanoseconds(state.zero_velocity_stamp);
  m.reinitializations = static_cast<std::int64_t>(state.reinitializations);
  m.odometry_applied = static_cast<std::int64_t>(state.odometry_applied);
  m.odometry_refused = static_cast<std::int64_t>(state.odometry_refused);
  return m;
}

NavState from_lcm(const maploop_lcm::nav_state_t& m) {
  NavState state;
  set_sample(state, m.header);
  state.status = enumerator_from(m.status, NavStatus::coasting, "nav_state_t.status");
  state.origin = {m.origin_latitude, m.origin_longitude, m.origin_height};
  read<3>(m.position_enu, state.position_enu);
  read<3>(m.velocity_enu, state.velocity_enu);
  state.attitude = {m.azimuth, m.pitch, m.roll};
  state.forward_speed = m.forward_speed;
  state.gyro_bias = m.gyro_bias;
  read<9>(m.covariance, state.covariance);
  state.imu_stamp = from_nanoseconds(m.imu_stamp_ns);
  state.odometry_stamp = from_nanoseconds(m.odometry_stamp_ns);
  state.gnss_stamp = from_nanoseconds(m.gnss_stamp_ns);
  state.wheel_stamp = from_nanoseconds(m.wheel_stamp_ns);
  state.zero_velocity_stamp = from_nanoseconds(m.zero_velocity_stamp_ns);
  state.reinitializations = static_cast<std::uint64_t>(m.reinitializations);
  state.odometry_applied = static_cast<std::uint64_t>(m.odometry_applied);
  state.odometry_refused = static_cast<std::uint64_t>(m.odometry_refused);
  return state;
}

maploop_lcm::relative_motion_t to_lcm(const RelativeMotion& motion) {
  maploop_lcm::relative_motion_t m{};
  m.header = header_of(motion);
  m.status = static_cast<std::int8_t>(motion.status);
  m.condition = static_cast<std::int8_t>(motion.condition);
  m.parallax = motion.parallax;
  m.from_ns = to_nanoseconds(motion.from);
  write<3>(motion.translation, m.translation);
  write<4>(motion.rotation.coeffs(), m.rotation_xyzw);
  write<6>(motion.covariance, m.covariance);
  m.tracked = motion.tracked;
  m.inliers = motion.inliers;
  m.source = static_cast<std::int8_t>(motion.source);
  return m;
}

RelativeMotion from_lcm(const maploop_lcm::relative_motion_t& m) {
  RelativeMotion motion;
  set_sample(motion, m.header);
  motion.status =
      enumerator_from(m.status, OdometryStatus::disagreement, "relative_motion_t.status");
  motion.condition =
      enumerator_from(m.condition, OdometryCondition::after_gap, "relative_motion_t.condition");
  motion.parallax = m.parallax;
  motion.from = from_nanoseconds(m.from_ns);
  read<3>(m.translation, motion.translation);
  read<4>(m.rotation_xyzw, motion.rotation.coeffs());
  read<6>(m.covariance, motion.covariance);
  motion.tracked = m.tracked;
  motion.inliers = m.inliers;
  motion.source =
      enumerator_from(m.source, OdometrySource::visual_lidar, "relative_motion_t.source");
  return motion;
}

maploop_lcm::lidar_motion_t to_lcm(const LidarMotion& motion) {
  maploop_lcm::lidar_motion_t m{};
  m.motion = to_lcm(static_cast<const RelativeMotion&>(motion));
  m.degenerate = static_cast<std::int8_t>(motion.degenerate);
  m.iterations = motion.iterations;
  m.seed_translation_error = motion.seed_translation_error;
  m.seed_rotation_error = motion.seed_rotation_error;
  return m;
}

LidarMotion from_lcm(const maploop_lcm::lidar_motion_t& m) {
  LidarMotion motion;
  static_cast<RelativeMotion&>(motion) = from_lcm(m.motion);
  motion.degenerate = static_cast<std::uint8_t>(m.degenerate);
  motion.iterations = m.iterations;
  motion.seed_translation_error = m.seed_translation_error;
  motion.seed_rotation_error = m.seed_rotation_error;
  return motion;
}

maploop_lcm::imu_t to_lcm(const ImuSample& sample) {
  maploop_lcm::imu_t m{};
  m.header = header_of(sample);
  m.specific_force_forward = sample.specific_force_forward;
  m.specific_force_left = sample.specific_force_left;
  m.yaw_rate = sample.yaw_rate;
  return m;
}

ImuSample from_lcm(const maploop_lcm::imu_t& m) {
  ImuSample sample;
  set_sample(sample, m.header);
  sample.specific_force_forward = m.specific_force_forward;
  sample.specific_force_left = m.specific_force_left;
  sample.yaw_rate = m.yaw_rate;
  return sample;
}

maploop_lcm::wheel_speed_t to_lcm(const WheelSpeed& sample) {
  maploop_lcm::wheel_speed_t m{};
  m.header = header_of(sample);
  m.speed = sample.speed;
  m.sigma = sample.sigma;
  return m;
}

WheelSpeed from_lcm(const maploop_lcm::wheel_speed_t& m) {
  WheelSpeed sample;
  set_sample(sample, m.header);
  sample.speed = m.speed;
  sample.sigma = m.sigma;
  return sample;
}

maploop_lcm::gnss_fix_t to_lcm(const GnssFix& fix) {
  maploop_lcm::gnss_fix_t m{};
  m.header = header_of(fix);
  m.latitude = fix.position.latitude;
  m.longitude = fix.position.longitude;
  m.height = fix.position.height;
  write<3>(fix.position_covariance, m.position_covariance);
  m.velocity_stamp_ns = to_nanoseconds(fix.velocity_stamp);
  write<3>(fix.velocity_enu, m.velocity_enu);
  write<3>(fix.velocity_covariance, m.velocity_covariance);
  return m;
}

GnssFix from_lcm(const maploop_lcm::gnss_fix_t& m) {
  GnssFix fix;
  set_sample(fix, m.header);
  fix.position = {m.latitude, m.longitude, m.height};
  read<3>(m.position_covariance, fix.position_covariance);
  fix.velocity_stamp = from_nanoseconds(m.velocity_stamp_ns);
  read<3>(m.velocity_enu, fix.velocity_enu);
  read<3>(m.velocity_covariance, fix.velocity_covariance);
  return fix;
}

maploop_lcm::reference_pose_t to_lcm(const ReferencePose& pose) {
  maploop_lcm::reference_pose_t m{};
  m.header = header_of(pose);
  m.latitude = pose.position.latitude;
  m.longitude = pose.position.longitude;
  m.height = pose.position.height;
  m.azimuth = pose.attitude.azimuth;
  m.pitch = pose.attitude.pitch;
  m.roll = pose.attitude.roll;
  m.velocity_stamp_ns = to_nanoseconds(pose.velocity_stamp);
  write<3>(pose.velocity_enu, m.velocity_enu);
  m.position_accuracy = pose.position_accuracy;
  return m;
}

ReferencePose from_lcm(const maploop_lcm::reference_pose_t& m) {
  ReferencePose pose;
  set_sample(pose, m.header);
  pose.position = {m.latitude, m.longitude, m.height};
  pose.attitude = {m.azimuth, m.pitch, m.roll};
  pose.velocity_stamp = from_nanoseconds(m.velocity_stamp_ns);
  read<3>(m.velocity_enu, pose.velocity_enu);
  pose.position_accuracy = m.position_accuracy;
  return pose;
}

maploop_lcm::health_t to_lcm(const Health& health) {
  maploop_lcm::health_t m{};
  m.utime = microseconds_of(health.stamp);
  convert_each(health.threads, m.threads, to_lcm);
  convert_each(health.rings, m.rings, to_lcm);
  convert_each(health.refusals, m.refusals, to_lcm);
  convert_each(health.outputs, m.outputs, to_lcm);
  convert_each(health.sensors, m.sensors, to_lcm);
  convert_each(health.settings, m.settings, to_lcm);
  m.degraded = health.degraded;
  m.thread_count = static_cast<std::int32_t>(m.threads.size());
  m.ring_count = static_cast<std::int32_t>(m.rings.size());
  m.refusal_count = static_cast<std::int32_t>(m.refusals.size());
  m.output_count = static_cast<std::int32_t>(m.outputs.size());
  m.sensor_count = static_cast<std::int32_t>(m.sensors.size());
  m.setting_count = static_cast<std::int32_t>(m.settings.size());
  m.degraded_count = static_cast<std::int32_t>(m.degraded.size());
  m.elapsed_s = health.elapsed;
  m.cpu_s = health.cpu;
  return m;
}

Health from_lcm(const maploop_lcm::health_t& m) {
  Health health;
  health.stamp = time_of_utime(m.utime);
  convert_each(m.threads, health.threads, from_lcm);
  convert_each(m.rings, health.rings, from_lcm);
  convert_each(m.refusals, health.refusals, from_lcm);
  convert_each(m.outputs, health.outputs, from_lcm);
  convert_each(m.sensors, health.sensors, from_lcm);
  convert_each(m.settings, health.settings, from_lcm);
  health.degraded = m.degraded;
  health.elapsed = m.elapsed_s;
  health.cpu = m.cpu_s;
  return health;
}

}  // namespace maploop
