// This file reads the samples of single sensors from a bag.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/lidar_scan.h"
#include "msgs/wheel_speed.h"
#include "sensors/bag/bag_recording.h"
#include "sensors/bag/message_reader.h"
#include "sensors/imu/mount_alignment.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Each source opens the recording by itself, from its start. A message that cannot be decoded, or
// is not later than the previous one, is left out and reported.
struct BagSettings {
  std::filesystem::path path;
  BagParameters parameters;
  BagVehicle vehicle;
  BagLimits limits;
  bool header_stamps = true;
  Duration turn{};           // of the LiDAR, from one cloud to the next
  double force_scale = 1.0;  // by which the inertial unit's specific force becomes m/s^2
};
using SharedBagSettings = std::shared_ptr<const BagSettings>;

// Pairs left and right images whose stamps differ by at most max_pair_skew.
std::unique_ptr<Source<StereoPair>> make_bag_camera(SharedBagSettings settings, const Topic& left,
                                                    const Topic& right, Time passed);

std::unique_ptr<Source<LidarScan>> make_bag_lidar(SharedBagSettings settings, const Topic& lidar,
                                                  Time passed);

std::unique_ptr<Source<SixAxisSample>> make_bag_imu(SharedBagSettings settings, const Topic& imu);

// Fixes have the velocity of the last message of `velocity` that is at most half a second older.
// Without that topic, one fix a second has the velocity of the parabola through it and the two
// before it. Other fixes have a velocity of zero with a standard deviation of 100 m/s.
std::unique_ptr<Source<GnssFix>> make_bag_gnss(SharedBagSettings settings, const Topic& gnss,
                                               const Topic* velocity);

// Returns a receiver's observations and subframes as the stream of UBX frames that it sent.
// Damage and messages that cannot be decoded are left out and reported.
std::string read_bag_ubx(const BagSettings& settings, const Topic& raw, const Topic* subframes,
                         SourceReport& report);

std::unique_ptr<Source<WheelSpeed>> make_bag_wheel(SharedBagSettings settings, const Topic& wheel);

}  // namespace maploop::sensors
