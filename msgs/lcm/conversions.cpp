#include "msgs/lcm/conversions.h"

#include "msgs/lcm/field_copy.h"

namespace maploop {

void convert(auto copy, Is<NavState> auto& state, auto& m) {
  copy.header(state, m.header);
  copy.choice(state.status, m.status, "nav_state_t.status");
  copy.place(state.origin, m.origin_latitude, m.origin_longitude, m.origin_height);
  copy(state.position_enu, m.position_enu);
  copy(state.velocity_enu, m.velocity_enu);
  copy(state.attitude.azimuth, m.azimuth);
  copy(state.attitude.pitch, m.pitch);
  copy(state.attitude.roll, m.roll);
  copy(state.forward_speed, m.forward_speed);
  copy(state.gyro_bias, m.gyro_bias);
  copy(state.covariance, m.covariance);
  copy(state.imu_stamp, m.imu_stamp_ns);
  copy(state.odometry_stamp, m.odometry_stamp_ns);
  copy(state.gnss_stamp, m.gnss_stamp_ns);
  copy(state.wheel_stamp, m.wheel_stamp_ns);
  copy(state.zero_velocity_stamp, m.zero_velocity_stamp_ns);
  copy(state.odometry_applied, m.odometry_applied);
  copy(state.odometry_refused, m.odometry_refused);
  copy(state.reinitializations, m.reinitializations);
}
MAPLOOP_CONVERSIONS(NavState, maploop_lcm::nav_state_t)

void convert(auto copy, Is<OdomState> auto& state, auto& m) {
  copy.header(state, m.header);
  copy.choice(state.status, m.status, "odom_state_t.status");
  copy(state.position, m.position);
  copy(state.attitude.azimuth, m.azimuth);
  copy(state.attitude.pitch, m.pitch);
  copy(state.attitude.roll, m.roll);
  copy(state.velocity_body, m.velocity_body);
  copy(state.yaw_rate, m.yaw_rate);
}
MAPLOOP_CONVERSIONS(OdomState, maploop_lcm::odom_state_t)

void convert_separation(auto copy, auto& separation, auto& m) {
  copy(separation.known, m.known);
  copy(separation.along, m.along);
  copy(separation.across, m.across);
  copy(separation.along_sigma, m.along_sigma);
  copy(separation.across_sigma, m.across_sigma);
}

void convert(auto copy, Is<NavProtection> auto& protection, auto& m) {
  copy.header(protection, m.header);
  copy(protection.doubted, m.doubted);
  copy(protection.risk, m.risk);
  copy(protection.along, m.along);
  copy(protection.across, m.across);
  copy(protection.horizontal, m.horizontal);
  convert_separation(copy, protection.without_map, m.without_map);
  convert_separation(copy, protection.without_gnss, m.without_gnss);
  convert_separation(copy, protection.without_odometry, m.without_odometry);
}
MAPLOOP_CONVERSIONS(NavProtection, maploop_lcm::nav_protection_t)

void convert_motion(auto copy, auto& motion, auto& m) {
  copy.header(motion, m.header);
  copy.choice(motion.status, m.status, "relative_motion_t.status");
  copy.choice(motion.condition, m.condition, "relative_motion_t.condition");
  copy(motion.parallax, m.parallax);
  copy(motion.from, m.from_ns);
  copy(motion.translation, m.translation);
  copy(motion.rotation.coeffs(), m.rotation_xyzw);
  copy(motion.covariance, m.covariance);
  copy(motion.tracked, m.tracked);
  copy(motion.inliers, m.inliers);
  copy.choice(motion.source, m.source, "relative_motion_t.source");
}

void convert(auto copy, Is<RelativeMotion> auto& motion, auto& m) {
  convert_motion(copy, motion, m);
}
MAPLOOP_CONVERSIONS(RelativeMotion, maploop_lcm::relative_motion_t)

void convert(auto copy, Is<LidarMotion> auto& motion, auto& m) {
  convert_motion(copy, motion, m.motion);
  copy(motion.degenerate, m.degenerate);
  copy(motion.iterations, m.iterations);
  copy(motion.seed_translation_error, m.seed_translation_error);
  copy(motion.seed_rotation_error, m.seed_rotation_error);
}
MAPLOOP_CONVERSIONS(LidarMotion, maploop_lcm::lidar_motion_t)

void convert(auto copy, Is<ImuSample> auto& sample, auto& m) {
  copy.header(sample, m.header);
  copy(sample.specific_force_forward, m.specific_force_forward);
  copy(sample.specific_force_left, m.specific_force_left);
  copy(sample.yaw_rate, m.yaw_rate);
  copy(sample.six_axes, m.six_axes);
  copy(sample.specific_force_up, m.specific_force_up);
  copy(sample.roll_rate, m.roll_rate);
  copy(sample.pitch_rate, m.pitch_rate);
}
MAPLOOP_CONVERSIONS(ImuSample, maploop_lcm::imu_t)

void convert(auto copy, Is<WheelSpeed> auto& wheel, auto& m) {
  copy.header(wheel, m.header);
  copy(wheel.speed, m.speed);
  copy(wheel.sigma, m.sigma);
}
MAPLOOP_CONVERSIONS(WheelSpeed, maploop_lcm::wheel_speed_t)

void convert(auto copy, Is<GnssIncrement> auto& increment, auto& m) {
  copy(increment.position, m.position);
  copy(increment.position_covariance, m.position_covariance);
  copy(increment.velocity_enu, m.velocity_enu);
  copy(increment.velocity_covariance, m.velocity_covariance);
  copy(increment.growth, m.growth);
}

void convert(auto copy, Is<GnssFix> auto& fix, auto& m) {
  copy.header(fix, m.header);
  copy.place(fix.position, m.latitude, m.longitude, m.height);
  copy(fix.position_covariance, m.position_covariance);
  copy(fix.velocity_stamp, m.velocity_stamp_ns);
  copy(fix.velocity_enu, m.velocity_enu);
  copy(fix.velocity_covariance, m.velocity_covariance);
  if constexpr (decltype(copy)::to_message) {
    m.carried = fix.increment.has_value();
  } else if (m.carried) {
    fix.increment.emplace();
  }
  if (fix.increment) convert(copy, *fix.increment, m.increment);
}
MAPLOOP_CONVERSIONS(GnssFix, maploop_lcm::gnss_fix_t)

void convert(auto copy, Is<ReferencePose> auto& pose, auto& m) {
  copy.header(pose, m.header);
  copy.place(pose.position, m.latitude, m.longitude, m.height);
  copy(pose.attitude.azimuth, m.azimuth);
  copy(pose.attitude.pitch, m.pitch);
  copy(pose.attitude.roll, m.roll);
  copy(pose.velocity_stamp, m.velocity_stamp_ns);
  copy(pose.velocity_enu, m.velocity_enu);
  copy(pose.position_accuracy, m.position_accuracy);
}
MAPLOOP_CONVERSIONS(ReferencePose, maploop_lcm::reference_pose_t)

}  // namespace maploop
