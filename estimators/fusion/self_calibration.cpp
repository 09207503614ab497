#include "estimators/fusion/self_calibration.h"

#include <cmath>

#include "msgs/frames.h"

namespace maploop::fusion {
namespace {

struct Named {
  int state;
  std::string_view name, unit;
  double per_unit;  // of the state's own unit
};
const std::array<Named, std::tuple_size_v<SelfCalibrations>> all{{
    {index::odometry_course, "odometry points to the right by", "deg", degrees(1.0)},
    {index::climb_offset, "direction of travel above body x", "deg", degrees(1.0)},
    {index::axle_distance, "rear axle behind the origin", "m", 1.0},
    {index::lever_forward, "GNSS antenna, forward", "m", 1.0},
    {index::lever_left, "GNSS antenna, to the left", "m", 1.0},
    {index::speed_scale, "scale of odometry or wheels", "%", 100.0},
    {index::lidar_scale, "scale of the LiDAR's motion", "%", 100.0},
    {index::lidar_turn, "drift of the LiDAR's turning", "deg/100 m", degrees(100.0)},
    {index::gyro_bias, "bias of the gyro", "deg/h", degrees(3600.0)},
    {index::forward_bias, "bias of the forward accelerometer", "m/s^2", 1.0},
    {index::left_bias, "bias of the left accelerometer", "m/s^2", 1.0},
}};

}  // namespace

SelfCalibrations self_calibrations(const FilterState& state, const StateVector& sigmas_at_start) {
  SelfCalibrations result;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Named& n = all[i];
    result[i] = {n.name, n.unit, n.per_unit * state.x[n.state],
                 n.per_unit * std::sqrt(state.P(n.state, n.state)),
                 n.per_unit * sigmas_at_start[n.state]};
  }
  return result;
}

}  // namespace maploop::fusion
