// This file opens the live sensors that [live] of the configuration names.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "msgs/calibration.h"

namespace maploop::vehicle {

struct LiveSensors;
struct VehicleConfig;

enum class GnssProtocol : std::uint8_t {
  nmea,          // the receiver's own fixes
  ubx,           // its own fixes in u-blox's binary protocol (NAV-PVT)
  observations,  // UBX or RTCM 3 (ppp/readers/streams/receiver_stream.h); the ppp thread computes
                 // fixes
};
constexpr std::array<std::string_view, 3> names_of(GnssProtocol) {
  return {"nmea", "ubx", "observations"};
}

// These are endpoints (sensors/live/endpoint.h), pipelines and more; config_tables.cpp describes
// each.
struct LiveParameters {
  std::string camera_left, camera_right;
  std::string velodyne;
  std::string velodyne_position;
  std::string imu;
  std::string imu_protocol = "ncom";
  std::string gnss;
  GnssProtocol gnss_protocol = GnssProtocol::nmea;
  double gnss_latency = 0.05;  // s
  int gnss_frequencies = 2;
  std::string corrections;
  std::string gnss_antenna;
};

// These do not connect to anything yet. They throw std::runtime_error naming the key of [live] or
// [vehicle] that is wrong and what it may be; the first one also throws if there is no sensor at
// all. The calibration is that of the described vehicle.
LiveSensors open_live_sensors(const VehicleConfig& config);
VehicleCalibration live_calibration(const VehicleConfig& config);

}  // namespace maploop::vehicle
