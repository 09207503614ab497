#include "estimators/fusion/self_calibration.h"

#include <cmath>

#include "estimators/fusion/joseph_update.h"
#include "msgs/frames.h"

namespace maploop::fusion {
namespace {

// Describes how long a property lasts: the share of its sigma at the start that is added to a value
// from a drive that has just ended, and after how many days the value is worth nothing.
struct Lasting {
  double share;
  double days;
};
constexpr Lasting mount{0.1, 365.0}, load{0.3, 30.0}, tyres{0.2, 90.0}, scanner{0.2, 365.0},
    bias{0.5, 1.0};

struct Property {
  int state;
  std::string_view key, name, unit;
  double per_unit;  // of the state's own unit
  Lasting lasting;
};
const std::array<Property, calibrated_count> all{{
    {index::odometry_course, "odometry_course", "odometry points to the right by", "deg",
     degrees(1.0), mount},
    {index::odometry_left, "odometry_left", "odometry described too far to the left by", "m", 1.0,
     mount},
    {index::climb_offset, "climb_offset", "direction of travel above body x", "deg", degrees(1.0),
     load},
    {index::axle_distance, "axle_distance", "rear axle behind the origin", "m", 1.0, mount},
    {index::rear_slip, "rear_slip", "slip angle of the rear tyres at 1 m/s^2", "deg", degrees(1.0),
     tyres},
    {index::lever_forward, "antenna_forward", "GNSS antenna, forward", "m", 1.0, mount},
    {index::lever_left, "antenna_left", "GNSS antenna, to the left", "m", 1.0, mount},
    {index::speed_scale, "speed_scale", "scale of odometry or wheels", "%", 100.0, tyres},
    {index::lidar_scale, "lidar_scale", "scale of the LiDAR's motion", "%", 100.0, scanner},
    {index::lidar_turn, "lidar_turn", "drift of the LiDAR's turning", "deg/100 m", degrees(100.0),
     scanner},
    {index::gyro_bias, "gyro_bias", "bias of the gyro", "deg/h", degrees(3600.0), bias},
    {index::forward_bias, "forward_bias", "bias of the forward accelerometer", "m/s^2", 1.0, bias},
    {index::left_bias, "left_bias", "bias of the left accelerometer", "m/s^2", 1.0, bias},
    {index::roll_gyro_bias, "roll_gyro_bias", "bias of the gyro about the forward axis", "deg/h",
     degrees(3600.0), bias},
    {index::pitch_gyro_bias, "pitch_gyro_bias", "bias of the gyro about the left axis", "deg/h",
     degrees(3600.0), bias},
    {index::up_bias, "up_bias", "bias of the upward accelerometer", "m/s^2", 1.0, bias},
    {index::unit_course, "unit_course", "inertial unit points to the left by", "deg", degrees(1.0),
     mount},
    {index::imu_delay, "imu_delay", "inertial data later than its stamps by", "ms", 1e3, mount},
    {index::gnss_delay, "gnss_delay", "stamps of fixes late by", "ms", 1e3, mount},
}};

}  // namespace

SelfCalibrations self_calibrations(const FilterState& state, const StateVector& sigmas_at_start) {
  SelfCalibrations result;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Property& p = all[i];
    result[i] = {p.key,
                 p.name,
                 p.unit,
                 p.per_unit * state.x[p.state],
                 p.per_unit * std::sqrt(state.P(p.state, p.state)),
                 p.per_unit * sigmas_at_start[p.state]};
  }
  return result;
}

double remembered_sigma(std::size_t property, double sigma, double sigma_at_start, Duration age) {
  const Lasting& lasting = all[property].lasting;
  constexpr double seconds_a_day = 86400.0;
  const double days = std::abs(to_seconds(age)) / seconds_a_day;
  return std::hypot(sigma, (lasting.share + days / lasting.days) * sigma_at_start);
}

void recall(FilterState& state, const RememberedCalibration& remembered,
            const StateVector& sigmas_at_start) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Property& p = all[i];
    if (!(remembered.sigma[i] > 0.0) || !(sigmas_at_start[p.state] > 0.0)) continue;
    const double sigma =
        remembered_sigma(i, remembered.sigma[i], p.per_unit * sigmas_at_start[p.state],
                         state.stamp - remembered.at) /
        p.per_unit;
    // (35) of METHOD.md
    Innovation<1> innovation(remembered.value[i] / p.per_unit - state.x[p.state], sigma * sigma);
    innovation.H(p.state) = 1.0;
    constexpr double gate = 25.0;  // five sigmas: it is not the car that is described
    if (innovation.nis(state.P) <= gate) joseph_update(state.x, state.P, innovation);
  }
}

}  // namespace maploop::fusion
