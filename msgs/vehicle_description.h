// This is everything that is known of a car, each value with a standard deviation: the tables
// [vehicle] and [vehicle.camera], [vehicle.lidar], [vehicle.imu], [vehicle.antenna] of a
// configuration file.
//
// Defaults are neutral: what is not known has the value of no particular car and a wide standard
// deviation. Poses are in the body frame (frames.h), whose origin is the inertial unit.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "msgs/calibration.h"
#include "msgs/parameter.h"
#include "msgs/road_side.h"

namespace maploop {

// This is the position of a sensor, measured from the body's origin, and its standard deviations.
struct SensorPosition {
  double forward = 0.0, left = 0.0, up = 0.0;                    // m
  double forward_sigma = 1.0, left_sigma = 1.0, up_sigma = 1.0;  // m
};

// This turns from the body's axes: first to the left by yaw, then nose up by pitch, then right side
// down by roll. A sensor without rotation has x forward, y left, z up; a camera looks forward.
struct SensorRotation {
  double roll = 0.0, pitch = 0.0, yaw = 0.0;                    // deg
  double roll_sigma = 3.0, pitch_sigma = 3.0, yaw_sigma = 3.0;  // deg
};

// This is how late a sensor's stamps are, and the standard deviation of it.
struct SensorTime {
  double delay = 0.0, delay_sigma = 0.1;  // s, from the measurement to its stamp
};

// Describes the car without its sensors; the origin is the body's.
struct CarDescription {
  std::string name;                          // what --state keeps of one car is not used on another
  RoadSide side_of_road = RoadSide::by_map;  // on which traffic keeps
  double rear_axle_distance = 0.0, rear_axle_distance_sigma = 1.0;  // m, axle to origin, forward
  double rear_axle_height = 0.0, rear_axle_height_sigma = 1.0;      // m, axle above the origin
  double wheel_radius = 0.32, wheel_radius_sigma = 0.05;            // m, rear wheel under load
  double track = 1.5, track_sigma = 0.2;                            // m, between the rear wheels
  double climb_offset = 0.0, climb_offset_sigma = 0.0175;  // rad, direction of travel above body x
  // rad/(m/s^2), slip angle of the rear tyres by lateral acceleration
  double rear_slip = 0.005, rear_slip_sigma = 0.003;
};

// The intrinsics are those of rectified images; the pose is that of the left camera.
struct CameraDescription {
  std::string calibration;    // file of the raw cameras; empty: the images are rectified
  int width = 0, height = 0;  // px; 0: not known
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;   // px, focal lengths and principal point
  double focal_sigma = 10.0, center_sigma = 10.0;  // px, of fx and fy; of cx and cy
  double baseline = 0.0, baseline_sigma = 0.01;    // m, from the left camera to the right
  SensorPosition position;                         // of the left camera
  SensorRotation rotation;                         // of the left camera
  SensorTime time;                                 // of the images
};

// Describes the LiDAR and its mounting.
struct LidarDescription {
  std::string model = "VLP-16";                              // or "HDL-32E", "HDL-64E"
  std::string calibration;                                   // file db.xml of an HDL-64E
  double beam_elevation = 0.0, beam_elevation_sigma = 0.01;  // rad, beams are higher than stated
  SensorPosition position;                                   // of the scanner's origin
  SensorRotation rotation;                                   // of the scanner's axes
  SensorTime time;                                           // of the scans
};

// Describes the mounting of the inertial unit, whose position is the body's origin.
struct ImuDescription {
  SensorRotation rotation;  // of the unit's own axes
  SensorTime time;          // of its samples
};

// Describes the antenna of the GNSS receiver.
struct AntennaDescription {
  SensorPosition position;  // lever arm from the inertial unit
  SensorTime time;          // of the receiver's fixes
};

// Describes a car with all its sensors.
struct VehicleDescription {
  CarDescription car;          // [vehicle]
  CameraDescription camera;    // [vehicle.camera]
  LidarDescription lidar;      // [vehicle.lidar]
  ImuDescription imu;          // [vehicle.imu]
  AntennaDescription antenna;  // [vehicle.antenna]
};

ParameterTable<CarDescription> parameter_table(const CarDescription&);
ParameterTable<CameraDescription> parameter_table(const CameraDescription&);
ParameterTable<LidarDescription> parameter_table(const LidarDescription&);
// Returns the parameters of a sensor's position, as part of the table `name`; `meaning` says which
// sensor it is. Both texts must outlive the result.
ParameterTable<SensorPosition> position_table(std::string_view name, std::string_view meaning);
// Returns those of its rotation.
ParameterTable<SensorRotation> rotation_table(std::string_view name, std::string_view meaning);
// Returns those of its delay.
ParameterTable<SensorTime> time_table(std::string_view name, std::string_view meaning);

// Calls part(table, values) for each part of one or more descriptions, in the order of the file.
// Parts of one sensor share a table of the file.
template <class Part, class... Description>
void each_table(Part&& part, Description&... d) {
  const auto mounted = [&](const auto& table, auto member) {
    part(position_table(table.name, table.meaning), (d.*member).position...);
    part(rotation_table(table.name, table.meaning), (d.*member).rotation...);
    part(time_table(table.name, table.meaning), (d.*member).time...);
  };
  using V = VehicleDescription;
  const ParameterTable<CameraDescription> camera = parameter_table(CameraDescription{});
  const ParameterTable<LidarDescription> lidar = parameter_table(LidarDescription{});
  part(parameter_table(CarDescription{}), d.car...);
  part(camera, d.camera...);
  mounted(camera, &V::camera);
  part(lidar, d.lidar...);
  mounted(lidar, &V::lidar);
  constexpr std::string_view imu = "vehicle.imu", antenna = "vehicle.antenna";
  constexpr std::string_view of_imu =
      "The inertial unit, whose position is the body's origin: its axes in the body's.";
  constexpr std::string_view of_antenna = "The antenna of the GNSS receiver.";
  part(rotation_table(imu, of_imu), d.imu.rotation...);
  part(time_table(imu, of_imu), d.imu.time...);
  part(position_table(antenna, of_antenna), d.antenna.position...);
  part(time_table(antenna, of_antenna), d.antenna.time...);
}

// Returns nullptr if the table has no such key.
template <class P>
const Parameter<P>* parameter_named(const ParameterTable<P>& table, std::string_view key) {
  for (const Parameter<P>& parameter : table.parameters)
    if (parameter.key == key) return &parameter;
  return nullptr;
}

// Returns what a parameter is the standard deviation of, or nullptr: "up" for "up_sigma".
template <class P>
const Parameter<P>* value_of_sigma(const ParameterTable<P>& table, const Parameter<P>& parameter) {
  constexpr std::string_view ending = "_sigma";
  if (!parameter.key.ends_with(ending)) return nullptr;
  return parameter_named(table, parameter.key.substr(0, parameter.key.size() - ending.size()));
}

// Returns T_body_sensor of a sensor with x forward, y left, z up.
Eigen::Isometry3d sensor_pose(const SensorPosition& position, const SensorRotation& rotation);
// Returns T_body_cam of a camera (x right, y down, z forward).
Eigen::Isometry3d camera_pose(const SensorPosition& position, const SensorRotation& rotation);

// Does the reverse of sensor_pose(); standard deviations are not changed.
void set_sensor_pose(const Eigen::Isometry3d& T_body_sensor, SensorPosition& position,
                     SensorRotation& rotation);
// Does the reverse of camera_pose(); standard deviations are not changed.
void set_camera_pose(const Eigen::Isometry3d& T_body_cam, SensorPosition& position,
                     SensorRotation& rotation);

// Returns what a calibration knows. A pose that it states has the standard deviations of a careful
// calibration, 2 cm and 0.2 deg.
VehicleDescription description_of(const VehicleCalibration& calibration);

// Returns the tables of a configuration file with every value that differs from its default, or
// whose standard deviation does; a comment gives unit and meaning.
std::string to_toml(const VehicleDescription& description);

}  // namespace maploop
