// This file joins what a recording and the configuration know of a vehicle.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <tuple>

#include "runtime/vehicle/config/vehicle_config.h"
#include "sensors/replay/kitti_calibration.h"

namespace maploop::vehicle {
namespace {

// Returns the recording's description with the given keys of the configuration in it. The standard
// deviation of the recording's value is not that of a given one.
VehicleDescription joined(const VehicleConfig& config, const VehicleCalibration& recorded) {
  VehicleDescription description = description_of(recorded);
  sensors::describe_kitti_car(recorded, description);
  const VehicleDescription neutral;
  each_table(
      [&](const auto& table, auto& values, const auto& given, const auto& defaults) {
        for (const auto& parameter : table.parameters) {
          const auto* of = value_of_sigma(table, parameter);
          if (config.is_given(table.name, parameter.key)) {
            parameter.set(values, parameter.value_in(given));
          } else if (of != nullptr && config.is_given(table.name, of->key)) {
            parameter.set(values, parameter.value_in(defaults));
          }
        }
      },
      description, config.vehicle, neutral);
  return description;
}

void take_pose(Eigen::Isometry3d& recorded, const Eigen::Isometry3d& given) {
  constexpr double rounding = 1e-9;  // m, rad: that of the text
  if ((given.matrix() - recorded.matrix()).cwiseAbs().maxCoeff() > rounding) recorded = given;
}

}  // namespace

bool has_pose(const VehicleConfig& config, std::string_view table) {
  for (const char* key : {"forward", "left", "up", "roll", "pitch", "yaw"})
    if (config.is_given(table, key)) return true;
  return false;
}

VehicleCalibration described(const VehicleConfig& config, VehicleCalibration recorded) {
  const VehicleDescription d = joined(config, recorded);
  recorded.rear_axle_distance = d.car.rear_axle_distance;
  recorded.climb_offset = d.car.climb_offset;
  recorded.climb_offset_sigma = d.car.climb_offset_sigma;
  recorded.beam_elevation = d.lidar.beam_elevation;
  if (has_pose(config, "vehicle.lidar"))
    take_pose(recorded.T_body_velo, sensor_pose(d.lidar.position, d.lidar.rotation));
  StereoCalibration& s = recorded.stereo;
  const CameraDescription& camera = d.camera;
  if (camera.calibration.empty() && camera.width > 0) {
    s.width = camera.width;
    s.height = camera.height;
    s.fx = camera.fx;
    s.fy = camera.fy;
    s.cx = camera.cx;
    s.cy = camera.cy;
    s.baseline = camera.baseline;
  }
  if (has_pose(config, "vehicle.camera"))
    take_pose(s.T_body_cam, camera_pose(camera.position, camera.rotation));
  return recorded;
}

void describe_car(VehicleConfig& config, const VehicleCalibration& recorded) {
  const VehicleDescription d = joined(config, recorded);
  config.vehicle = d;
  const auto take = [&](std::string_view table, std::string_view key, double& value, double known) {
    if (!config.is_given(table, key)) value = known;
  };
  fusion::FusionParameters& p = config.fusion;
  take("fusion", "rear_axle_distance", p.rear_axle_distance, d.car.rear_axle_distance);
  take("fusion", "climb_offset", p.climb_offset, d.car.climb_offset);
  take("fusion", "climb_offset_sigma", p.climb_offset_sigma, d.car.climb_offset_sigma);
  take("fusion", "rear_slip", p.rear_slip, d.car.rear_slip);
  take("fusion", "rear_slip_sigma", p.rear_slip_sigma, d.car.rear_slip_sigma);
  take("lidar", "elevation_correction", config.lidar.elevation_correction, d.lidar.beam_elevation);
  // No recording knows these.
  const SensorPosition& antenna = d.antenna.position;
  for (const auto& [key, lever, known] :
       {std::tuple("forward", &p.gnss_lever_forward, antenna.forward),
        std::tuple("left", &p.gnss_lever_left, antenna.left),
        std::tuple("up", &p.gnss_lever_up, antenna.up)}) {
    if (config.is_given("vehicle.antenna", key))
      take("fusion", std::string("gnss_lever_") + key, *lever, known);
  }
  // What nobody has described keeps the standard deviation of [fusion]. So does the axle: a delay
  // of odometry by 30 ms looks as if the axle were 0.3 m elsewhere at 10 m/s.
  const VehicleDescription neutral;
  if (antenna.forward_sigma != neutral.antenna.position.forward_sigma) {
    take("fusion", "gnss_lever_sigma", p.gnss_lever_sigma,
         std::max({antenna.forward_sigma, antenna.left_sigma, antenna.up_sigma}));
  }
  if (const double sigma = d.imu.time.delay_sigma; sigma != neutral.imu.time.delay_sigma) {
    const double seen = d.camera.time.delay_sigma;
    take("fusion", "imu_delay_sigma", p.imu_delay_sigma,
         seen == neutral.camera.time.delay_sigma ? sigma : std::hypot(sigma, seen));
  }
  if (const double sigma = d.antenna.time.delay_sigma; sigma != neutral.antenna.time.delay_sigma)
    take("fusion", "gnss_delay_sigma", p.gnss_delay_sigma, sigma);
  if (config.is_given("vehicle.imu", "delay")) config.replay.imu_delay = d.imu.time.delay;
  if (!config.is_given("map", "side_of_road")) config.map.side_of_road = d.car.side_of_road;
}

}  // namespace maploop::vehicle
