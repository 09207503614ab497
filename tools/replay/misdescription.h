// A car that its owner has measured badly: what its description says, against what its recording
// shows.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>

#include "msgs/calibration.h"
#include "msgs/named_enum.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/graph/sensors.h"

namespace maploop::tools {

// A Property is what the description of the car states wrongly.
enum class Property : std::uint8_t {
  nothing,
  antenna,        // its place by 0.5 m, in a horizontal direction
  mount,          // the axes of the inertial unit by 1 deg about each
  camera,         // the pose of what odometry is from: 0.5 m horizontally, 1 deg of yaw
  axle,           // the rear axle by 0.5 m
  imu_stamps,     // 30 ms early or late
  gnss_stamps,    // the same
  camera_stamps,  // the same
  everything,
};
constexpr auto names_of(Property) {
  return names_up_to<Property::everything>({"nothing", "antenna", "inertial-mount", "camera",
                                            "rear-axle", "inertial-stamps", "gnss-stamps",
                                            "camera-stamps", "everything"});
}

// Throws std::invalid_argument with all names if there is no such property.
Property property_named(const std::string& name);

// How far the description is from the car. Every value is zero where it is right.
struct Misdescription {
  Eigen::Vector3d antenna = Eigen::Vector3d::Zero();       // m, body
  Eigen::Matrix3d mount = Eigen::Matrix3d::Identity();     // turns what the unit measures
  Eigen::Vector3d camera_place = Eigen::Vector3d::Zero();  // m, body
  double camera_yaw = 0.0;                                 // rad
  double axle = 0.0;                                       // m
  Duration imu_stamps{}, gnss_stamps{}, camera_stamps{};   // late
};

// Signs and directions depend on the seed alone, so that of `everything` each part is that of the
// property alone.
Misdescription misdescription(Property property, std::int64_t seed);

// Adds it to what is known of the car by config.vehicle and the recording, which was opened with
// the right description. The places of antenna and axle then count as given without a standard
// deviation, also where nothing is wrong, so that the right description differs from the wrong one
// in its values alone. Throws std::runtime_error if the recording has images or scans, whose
// motions cannot be changed.
void misdescribe(vehicle::VehicleConfig& config, vehicle::Recording& recording,
                 const Misdescription& wrong);

// Makes of the sensors of a recording what a vehicle with that description would take from them.
// Odometry is that of recorded motions.
void misdescribe(vehicle::Sensors& sensors, const Misdescription& wrong,
                 const VehicleCalibration& calibration);

}  // namespace maploop::tools
