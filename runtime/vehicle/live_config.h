// Opens the live sensors that [live] of the configuration names.
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
  observations,  // UBX or RTCM 3 (ppp/readers/receiver_stream.h); the ppp thread computes fixes
};
constexpr std::array<std::string_view, 3> names_of(GnssProtocol) {
  return {"nmea", "ubx", "observations"};
}

// The sensors are named by endpoints (sensors/live/endpoint.h); an empty one means that the vehicle
// does not have the sensor.
struct LiveParameters {
  // This is the folder of KITTI's three calibration texts, relative to the configuration's own
  // folder. They contain where the sensors are on the vehicle. If it is empty, the LiDAR is at the
  // body's origin.
  std::string calibration;
  // These are GStreamer pipelines (sensors/live/video_pipeline.h). If there is no right one, the
  // left one's images contain those of both cameras side by side.
  std::string camera_left, camera_right;
  double camera_delay = 0.0;      // s, from the middle of the exposure to the driver's stamp
  std::string velodyne;           // data packets, udp
  std::string velodyne_position;  // position packets with the UTC of its GNSS receiver, udp
  std::string velodyne_model = "VLP-16";
  std::string velodyne_calibration;  // db.xml of an HDL-64E, relative to the configuration
  std::string imu;                   // udp for NCOM, any endpoint for the others
  // The protocol is "ncom" (of an OXTS unit), "lines" (sensors/imu/imu_line.h) or "xsens"
  // (sensors/imu/xsens.h).
  std::string imu_protocol = "ncom";
  double imu_delay = 0.060;  // s, delay of its filters
  std::string gnss;          // the receiver, any endpoint
  GnssProtocol gnss_protocol = GnssProtocol::nmea;
  double gnss_latency = 0.05;  // s, least time from an epoch to the end of its transmission
  // The rest is for a receiver of observations.
  int gnss_frequencies = 2;  // 1: there is no ionosphere-free combination
  std::string corrections;   // RTCM 3 with ephemerides and SSR
  std::string gnss_antenna;  // "NAME" or "NAME RADOME" as in ANTEX; empty: unknown
};

// These do not connect to anything yet. They throw std::runtime_error naming the key of [live] that
// is wrong and what it may be; the first one also throws if there is no sensor at all.
LiveSensors open_live_sensors(const VehicleConfig& config);
VehicleCalibration live_calibration(const VehicleConfig& config);

}  // namespace maploop::vehicle
