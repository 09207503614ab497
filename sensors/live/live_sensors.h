// The sensors that can be listened to.
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

// `clock` must outlive what is made. Both throw std::invalid_argument where an endpoint is not of
// a kind that the sensor can be read from.
std::unique_ptr<LiveSource<LidarScan>> listen_to_velodyne(LiveVelodyneOptions options,
                                                          const HostClock& clock);

struct LiveStereoOptions {
  std::string left;              // GStreamer pipeline (video_pipeline.h)
  std::string right;             // the same; empty: the left one's images have both, side by side
  int width = 0, height = 0;     // px, of one image as it comes
  std::optional<StereoRig> rig;  // raw cameras: pairs are rectified; else they are
  Duration delay{};              // from the middle of the exposure to the driver's stamp
  Duration max_skew = std::chrono::milliseconds(20);  // of the stamps of one pair
};

// Throws std::invalid_argument where a pipeline is none, or the size is not known.
std::unique_ptr<LiveSource<StereoPair>> listen_to_cameras(LiveStereoOptions options,
                                                          const HostClock& clock);

// An OXTS unit's NCOM, a packet a datagram. Its values are `delay` older than its clock says.
std::unique_ptr<LiveSource<ImuSample>> listen_to_ncom(Endpoint endpoint, Duration delay,
                                                      const HostClock& clock);

// Lines of text (imu_line.h), over anything. Its values are `delay` older than they say.
std::unique_ptr<LiveSource<ImuSample>> listen_to_imu_lines(Endpoint endpoint, Duration delay,
                                                           const HostClock& clock);

// An Xsens MTi's MTData2 (imu/xsens.h), over a stream; the unit's x axis is forward. Its values are
// `delay` older than its clock says.
std::unique_ptr<LiveSource<ImuSample>> listen_to_xsens(Endpoint endpoint, Duration delay,
                                                       const HostClock& clock);

// A receiver's NMEA sentences, over anything.
std::unique_ptr<LiveSource<GnssFix>> listen_to_nmea(Endpoint endpoint,
                                                    const NmeaParameters& parameters,
                                                    const HostClock& clock);

}  // namespace maploop::sensors
