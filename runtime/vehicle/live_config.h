// The sensors that a vehicle listens to on the road.
#pragma once

#include <string>

#include "msgs/calibration.h"

namespace maploop::vehicle {

struct LiveSensors;
struct VehicleConfig;

// Endpoints (sensors/live/endpoint.h); empty: the vehicle has none of them.
struct LiveParameters {
  // Folder of KITTI's three calibration texts, from the configuration's own folder: where sensors
  // are on the vehicle. Empty: a LiDAR at the body's origin.
  std::string calibration;
  std::string velodyne;           // data packets, udp
  std::string velodyne_position;  // position packets, udp: UTC of its receiver
  std::string velodyne_model = "VLP-16";
  std::string velodyne_calibration;  // db.xml of an HDL-64E, from the configuration's own folder
  std::string imu;                   // NCOM of an OXTS unit, udp
  double imu_delay = 0.060;          // s, of its filters
  std::string gnss;                  // NMEA of a receiver, anything
  double gnss_latency = 0.05;        // s, from an epoch to the end of its sentences, at least
};

// Connects nothing yet. Throws std::runtime_error naming the key of [live] that is wrong and what
// it may be; also where there is no sensor at all.
LiveSensors open_live_sensors(const VehicleConfig& config);
VehicleCalibration live_calibration(const LiveParameters& parameters);

}  // namespace maploop::vehicle
