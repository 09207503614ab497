// Everything that can be set about the vehicle.
#pragma once

#include <filesystem>
#include <string>

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/stereo/parameters.h"
#include "runtime/core/realtime_memory.h"
#include "runtime/core/trace.h"
#include "runtime/vehicle/lcm_bus.h"
#include "runtime/vehicle/scheduling_config.h"
#include "sensors/replay/kitti_drive.h"

namespace maploop::vehicle {

struct VehicleConfig {
  std::string lcm_url = LcmBus::default_url;
  SchedulingParameters scheduling;
  runtime::MemoryParameters memory;
  runtime::TraceParameters trace;
  sensors::KittiDriveParameters replay;
  sensors::GnssAidParameters gnss;
  stereo::StereoParameters stereo;
  // KITTI's car travels 0.48 deg above its IMU's x axis: mean of eight odometry sequences (0.14 to
  // 0.86 deg).
  fusion::FusionParameters fusion{.climb_offset = 0.0084, .climb_offset_sigma = 0.0087};
};

// Reads a TOML file; absent keys keep their defaults. Throws runtime::ConfigError naming file, line
// and key for anything wrong, unknown keys included. runtime/vehicle/maploop.toml lists every key.
VehicleConfig load_vehicle_config(const std::filesystem::path& file);

// Every key with its value, as load_vehicle_config() reads it back.
std::string to_toml(const VehicleConfig& config);

}  // namespace maploop::vehicle
