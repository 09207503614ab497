// The sensors that a vehicle listens to on the road.
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
  ubx,           // the same, in u-blox's binary protocol (NAV-PVT)
  observations,  // UBX or RTCM 3 (ppp/readers/receiver_stream.h), which the ppp thread makes fixes
                 // of
};
constexpr std::array<std::string_view, 3> names_of(GnssProtocol) {
  return {"nmea", "ubx", "observations"};
}

// Endpoints (sensors/live/endpoint.h); empty: the vehicle has none of them.
struct LiveParameters {
  // Folder of KITTI's three calibration texts, from the configuration's own folder: where sensors
  // are on the vehicle. Empty: a LiDAR at the body's origin.
  std::string calibration;
  // GStreamer pipelines (sensors/live/video_pipeline.h); without a right one the left one's images
  // have both cameras', side by side.
  std::string camera_left, camera_right;
  double camera_delay = 0.0;      // s, from the middle of the exposure to the driver's stamp
  std::string velodyne;           // data packets, udp
  std::string velodyne_position;  // position packets, udp: UTC of its receiver
  std::string velodyne_model = "VLP-16";
  std::string velodyne_calibration;  // db.xml of an HDL-64E, from the configuration's own folder
  std::string imu;                   // udp for NCOM, anything for the others
  // Of an OXTS unit; or "lines" (sensors/imu/imu_line.h), "xsens" (sensors/imu/xsens.h).
  std::string imu_protocol = "ncom";
  double imu_delay = 0.060;  // s, of its filters
  std::string gnss;          // a receiver, anything
  GnssProtocol gnss_protocol = GnssProtocol::nmea;
  double gnss_latency = 0.05;  // s, from an epoch to the end of what is sent of it, at least
  // Of a receiver of observations.
  int gnss_frequencies = 2;  // 1: no combination free of the ionosphere
  std::string corrections;   // RTCM 3 with ephemerides and SSR, for these
  std::string gnss_antenna;  // "NAME", or "NAME RADOME", as ANTEX has it; empty: not known
};

// Connects nothing yet. Throws std::runtime_error naming the key of [live] that is wrong and what
// it may be; also where there is no sensor at all.
LiveSensors open_live_sensors(const VehicleConfig& config);
VehicleCalibration live_calibration(const VehicleConfig& config);

}  // namespace maploop::vehicle
