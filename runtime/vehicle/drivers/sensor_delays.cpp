#include "runtime/vehicle/drivers/sensor_delays.h"

#include <utility>

#include "sensors/delayed.h"

namespace maploop::vehicle {

SensorDelays delays_of(const VehicleConfig& config) {
  const VehicleDescription& d = config.vehicle;
  return {from_seconds(d.camera.time.delay), from_seconds(d.lidar.time.delay),
          from_seconds(d.imu.time.delay), from_seconds(d.antenna.time.delay)};
}

SensorDelays delays_of_oxts(const VehicleConfig& config) {
  SensorDelays delays = delays_of(config);
  delays.imu = {};
  return delays;
}

void take_delays(Sensors& s, const SensorDelays& delays) {
  const auto take = [](auto& source, Duration delay) {
    source = sensors::delayed(std::move(source), delay);
  };
  take(s.camera, delays.camera);
  take(s.odometry, delays.camera);
  take(s.visual, delays.camera);
  take(s.velodyne, delays.lidar);
  take(s.imu, delays.imu);
  take(s.gnss, delays.antenna);
}

std::unique_ptr<sensors::Source<GnssFix>> on_the_units_clock(
    std::unique_ptr<sensors::Source<GnssFix>> fixes, const std::vector<GnssOutage>& outages,
    const SensorDelays& delays) {
  return sensors::delayed(with_outages(sensors::delayed(std::move(fixes), delays.antenna), outages),
                          -delays.imu);
}

}  // namespace maploop::vehicle
