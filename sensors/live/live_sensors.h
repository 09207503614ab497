// This file declares the drivers of all live sensors.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "sensors/camera/stereo_rig.h"
#include "sensors/clock/host_clock.h"
#include "sensors/gnss/nmea_fixes.h"
#include "sensors/live/endpoint.h"
#include "sensors/live/live_source.h"
#include "sensors/velodyne/lasers.h"

namespace maploop::sensors {

struct LiveVelodyneOptions {
  Endpoint data;                     // udp; scanners send to port 2368
  std::optional<Endpoint> position;  // udp; scanners send to port 8308
  VelodyneModel model = VelodyneModel::vlp16;
  std::vector<Laser> lasers;
};

// `clock` must outlive the source that is made. Throws std::invalid_argument if an endpoint is of a
// kind from which the sensor cannot be read.
std::unique_ptr<LiveSource<LidarScan>> listen_to_velodyne(LiveVelodyneOptions options,
                                                          const HostClock& clock);

struct LiveStereoOptions {
  std::string left;              // GStreamer pipeline (video_pipeline.h)
  std::string right;             // the same; if empty, `left` sends both side by side
  int width = 0, height = 0;     // px, of one image as it arrives
  std::optional<StereoRig> rig;  // of raw cameras; if unset, pairs arrive rectified
  Duration delay{};              // from the middle of the exposure to the driver's stamp
  Duration max_skew = std::chrono::milliseconds(20);  // of the stamps of one pair
};

// Throws std::invalid_argument if a pipeline cannot be parsed, or the image size is not known.
std::unique_ptr<LiveSource<StereoPair>> listen_to_cameras(LiveStereoOptions options,
                                                          const HostClock& clock);

// Reads an OXTS unit's NCOM, one packet a datagram. The values are `delay` older than the unit's
// clock states.
std::unique_ptr<LiveSource<ImuSample>> listen_to_ncom(Endpoint endpoint, Duration delay,
                                                      const HostClock& clock);

// Reads lines of text (imu_line.h) over any connection. The values are `delay` older than the lines
// state.
std::unique_ptr<LiveSource<ImuSample>> listen_to_imu_lines(Endpoint endpoint, Duration delay,
                                                           const HostClock& clock);

// Reads an Xsens MTi's MTData2 (imu/xsens.h) over a stream; the unit's x axis is forward. The
// values are `delay` older than the unit's clock states.
std::unique_ptr<LiveSource<ImuSample>> listen_to_xsens(Endpoint endpoint, Duration delay,
                                                       const HostClock& clock);

// Reads a receiver's NMEA sentences over any connection.
std::unique_ptr<LiveSource<GnssFix>> listen_to_nmea(Endpoint endpoint,
                                                    const NmeaParameters& parameters,
                                                    const HostClock& clock);

}  // namespace maploop::sensors
