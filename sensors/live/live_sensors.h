// The sensors that can be listened to.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "msgs/gnss.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
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

// An OXTS unit's NCOM, a packet a datagram. Its values are `delay` older than its clock says.
std::unique_ptr<LiveSource<ImuSample>> listen_to_ncom(Endpoint endpoint, Duration delay,
                                                      const HostClock& clock);

// A receiver's NMEA sentences, over anything.
std::unique_ptr<LiveSource<GnssFix>> listen_to_nmea(Endpoint endpoint,
                                                    const NmeaParameters& parameters,
                                                    const HostClock& clock);

}  // namespace maploop::sensors
