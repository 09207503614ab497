#include "runtime/vehicle/live_config.h"

#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "runtime/vehicle/vehicle.h"
#include "runtime/vehicle/vehicle_config.h"
#include "sensors/live/live_sensors.h"
#include "sensors/replay/kitti_calibration.h"

namespace maploop::vehicle {
namespace {

// What a key of [live] is about to make; errors name the key.
template <class Make>
auto of_key(const char* key, Make&& make) {
  try {
    return make();
  } catch (const std::exception& e) {
    throw std::runtime_error(std::string("[live] ") + key + ": " + e.what());
  }
}

sensors::LiveVelodyneOptions velodyne_options(const LiveParameters& p) {
  sensors::LiveVelodyneOptions options{sensors::parse_endpoint(p.velodyne), {}, {}, {}};
  if (!p.velodyne_position.empty()) {
    options.position = sensors::parse_endpoint(p.velodyne_position);
  }
  const auto model = sensors::velodyne_model(p.velodyne_model);
  if (!model) {
    throw std::runtime_error("no scanner is called '" + p.velodyne_model +
                             "'; there are HDL-64E, HDL-32E, VLP-16");
  }
  options.model = *model;
  options.lasers = p.velodyne_calibration.empty()
                       ? sensors::factory_lasers(*model)
                       : sensors::read_velodyne_calibration(p.velodyne_calibration, *model);
  return options;
}

}  // namespace

VehicleCalibration live_calibration(const LiveParameters& p) {
  if (p.calibration.empty()) return {};
  return of_key("calibration", [&] { return sensors::read_kitti_calibration(p.calibration); });
}

LiveSensors open_live_sensors(const VehicleConfig& config) {
  const LiveParameters& p = config.live;
  LiveSensors s;
  s.clock = std::make_shared<const sensors::HostClock>();
  if (!p.velodyne.empty()) {
    s.velodyne = of_key("velodyne",
                        [&] { return sensors::listen_to_velodyne(velodyne_options(p), *s.clock); });
  }
  if (!p.imu.empty()) {
    s.imu = of_key("imu", [&] {
      return sensors::listen_to_ncom(sensors::parse_endpoint(p.imu), from_seconds(p.imu_delay),
                                     *s.clock);
    });
  }
  if (!p.gnss.empty()) {
    s.gnss = of_key("gnss", [&] {
      sensors::NmeaParameters nmea;
      nmea.latency = p.gnss_latency;
      return sensors::listen_to_nmea(sensors::parse_endpoint(p.gnss), nmea, *s.clock);
    });
  }
  if (!s.velodyne && !s.imu && !s.gnss) {
    throw std::runtime_error(
        "the configuration names no live sensor: give [live] velodyne, imu or gnss an endpoint, "
        "such as udp://:2368");
  }
  return s;
}

}  // namespace maploop::vehicle
