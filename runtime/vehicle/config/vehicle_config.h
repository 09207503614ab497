// This file has everything that can be set about the vehicle; config_tables.h describes each
// parameter.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/guard_parameters.h"
#include "estimators/fusion/protection_parameters.h"
#include "estimators/lidar/parameters.h"
#include "estimators/stereo/parameters.h"
#include "mapmatch/feedback_parameters.h"
#include "mapmatch/match_parameters.h"
#include "msgs/calibration.h"
#include "msgs/vehicle_description.h"
#include "ppp/filter/parameters.h"
#include "runtime/core/realtime_memory.h"
#include "runtime/core/trace.h"
#include "runtime/vehicle/config/live_config.h"
#include "runtime/vehicle/config/scheduling_config.h"
#include "runtime/vehicle/health/load_shedding.h"
#include "sensors/bag/bag_parameters.h"
#include "sensors/imu/mount_alignment.h"
#include "sensors/replay/error_model.h"
#include "sensors/replay/kitti_drive.h"
#include "sensors/replay/pose_odometry.h"

namespace maploop::ppp {
struct SetupOptions;
}  // namespace maploop::ppp

namespace maploop::vehicle {

// These say which pictures and scans dashboards get.
struct PreviewParameters {
  double rate = 2.0;  // Hz
  int width = 640;    // px
  int quality = 60;
  int points = 4000;
};

// These are about a drive with the observations of a GNSS receiver.
struct PppConfig {
  bool observations = true;
  std::vector<std::string> products;
  bool broadcast = false;
  double latency = 0.1;  // s
  double integrity_risk = 1e-4;
  std::string heights, geoid;
  ppp::PppParameters filter;
};

// Returns what precise point positioning is set up with.
ppp::SetupOptions setup_options(const PppConfig& config);

enum class MapMode : std::uint8_t {
  none,        // no matching
  loose,       // the fused state is matched, and nothing is fed back
  tight,       // the road is fed back to the filter
  hard_reset,  // position and azimuth of the filter are replaced by the matched ones
};
constexpr std::array<std::string_view, 4> names_of(MapMode) {
  return {"none", "loose", "tight", "hard-reset"};
}

struct MapParameters {
  std::string file;
  MapMode mode = MapMode::loose;
  RoadSide side_of_road = RoadSide::by_map;  // that of [vehicle] if it is not given
  std::string rules;
};

struct VehicleConfig {
  VehicleConfig();

  // Returns whether the file has that key, such as "forward" of "vehicle.camera"; "" is the top
  // level.
  bool is_given(std::string_view table, std::string_view key) const;

  std::string lcm_url;
  std::string configuration;  // "auto"
  std::string imu_grade = "tactical";
  std::string odometry = "visual-lidar";
  SchedulingParameters scheduling;
  runtime::MemoryParameters memory;
  runtime::TraceParameters trace;
  PreviewParameters preview;
  OverloadParameters overload;
  std::string vehicle_file;
  VehicleDescription vehicle;
  sensors::KittiDriveParameters replay;
  sensors::BagParameters bag;
  sensors::PoseOdometryParameters odometry_poses;
  LiveParameters live;
  sensors::GnssAidParameters gnss;
  std::string gnss_outage;  // gnss_outage.h
  sensors::WheelOdometerParameters wheel;
  std::string imu_noise = "recorded";
  sensors::ErrorModel imu_errors = sensors::ErrorModel::given;
  std::int64_t imu_seed = 1;
  stereo::StereoParameters stereo;
  lidar::LidarParameters lidar;
  PppConfig ppp;
  MapParameters map;
  mapmatch::MatchParameters mapmatch;
  mapmatch::FeedbackParameters feedback;
  fusion::GuardParameters guard;
  fusion::ProtectionParameters protection;
  fusion::FusionParameters fusion;
  std::set<std::string, std::less<>> given;  // keys that the file has, as "fusion.climb_offset"
};

// These set a name with what it means for [fusion]. They throw std::invalid_argument listing the
// names.
void set_configuration(VehicleConfig& config, const std::string& name);
void set_imu_grade(VehicleConfig& config, const std::string& name);

// Returns whether the file gives the pose of a sensor, which is named as in "vehicle.camera".
bool has_pose(const VehicleConfig& config, std::string_view table);

// Returns the calibration of a recording, with what the configuration says of the vehicle in place
// of the recording's own. A pose that agrees with the recording's to 1e-9 (m, rad) is that pose, so
// that a description that was converted from a calibration does not change a bit.
VehicleCalibration described(const VehicleConfig& config, VehicleCalibration recorded);

// Completes config.vehicle with what a recording knows, and sets the keys of [fusion], [lidar],
// [feedback] and the delay of OXTS rows by it; a key that the file gives in these tables holds.
void describe_car(VehicleConfig& config, const VehicleCalibration& recorded);

// Reads a TOML file; absent keys keep their defaults, and so do all without a file (empty). Throws
// runtime::ConfigError naming file, line and key for anything wrong: unknown keys, with the place
// of those that have moved, and values out of their range. runtime/vehicle/config/maploop.toml
// lists every key. `settings` (of --set) are texts TABLE.KEY=VALUE, which are read as if they stood
// at the end of the file; the quotes of a text may be left out. Paths in them start from the
// current folder. `topics` (of --topic) follow [bag] topics.
VehicleConfig load_vehicle_config(const std::filesystem::path& file,
                                  const std::vector<std::string>& settings = {},
                                  const std::vector<std::string>& topics = {});

// Returns every key with its value, as load_vehicle_config() reads it back, but for users and
// passwords (without_secrets() of sensors/live/endpoint.h).
std::string to_toml(const VehicleConfig& config);

}  // namespace maploop::vehicle
