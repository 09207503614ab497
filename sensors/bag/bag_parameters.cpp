#include "sensors/bag/bag_parameters.h"

namespace maploop::sensors {

ParameterTable<BagParameters> parameter_table(const BagParameters&) {
  using enum Audience;
  using P = BagParameters;
  constexpr double most = 1e6;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"topics", &P::topics, usual,
       "Which topic is which sensor: SENSOR=TOPIC, or SENSOR=none for a sensor that is not used. "
       "Sensors are camera.left, camera.right, camera.left_info, camera.right_info, lidar, imu, "
       "gnss, gnss.velocity and wheel. What is not named is found by type and name."},
      {"stamps", one_of<&P::stamps>, usual,
       "Stamps of the samples: \"header\": those of the messages; \"received\": when the recorder "
       "received them; \"auto\": those of the messages if they increase and are of one clock."},
      {"cloud_stamp", one_of<&P::cloud_stamp>, usual,
       "Which moment of a turn the stamp of a cloud is, if its points have no times."},
      {"gnss_position_sigma", &P::gnss_position_sigma, above_zero, most, "m", usual,
       "Standard deviation per horizontal axis of a fix without a covariance."},
      {"gnss_velocity_sigma", &P::gnss_velocity_sigma, above_zero, most, "m/s", usual,
       "Standard deviation per axis of the velocity of gnss.velocity."},
      {"wheel_sigma", &P::wheel_sigma, above_zero, most, "m/s", usual,
       "Standard deviation of the speed of wheel."},
  });
  return {"bag", "ROS bags and MCAP files.", table};
}

}  // namespace maploop::sensors
