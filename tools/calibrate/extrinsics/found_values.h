// This file collects what is found of a vehicle, and writes what is observed into its description.
#pragma once

#include <string>

#include "tools/calibrate/extrinsics/extrinsics.h"

namespace maploop::extrinsics {

class FoundValues {
 public:
  explicit FoundValues(const VehicleDescription& described);

  const VehicleDescription& description() const { return found_.description; }
  Extrinsics take() { return std::move(found_); }

  void say(std::string sentence) { found_.sentences.push_back(std::move(sentence)); }

  // Notes a pair of sensors, and why nothing is found of it.
  void add(const SensorPair& pair);
  void set_camera_lidar(const HandEye& eye) { found_.camera_lidar = eye; }
  void set_camera_rotation(const JointRotation& rotation);
  void set_lidar_rotation(const JointRotation& rotation);
  // What is added to the described delay of a sensor, against the camera or, without one, the
  // LiDAR.
  struct MoreDelay {
    std::string sensor;
    double more = 0.0, sigma = 0.0;  // s
  };
  // No sensor stamps before it measures: if a delay would be negative, that of the sensor which
  // the others are compared with is made longer, and the others' too.
  void set_delays(const std::string& compared_with, const std::vector<MoreDelay>& found);
  void set_forward(const std::string& sensor, const Travel& travel);  // "camera", "lidar"
  // Of camera and LiDAR, the one whose place is described better stays where it is.
  void set_lidar_position(const HandEye& eye, const JointRotation& rotation);
  void set_mount(const sensors::Mount& mount);

 private:
  struct Change {
    const char* key;
    double &value, &sigma;  // in the description
    double new_value, new_sigma;
  };
  void put(const std::string& sensor, const char* unit, bool observed, const Change& change);
  void put_rotation(const std::string& sensor, SensorRotation& rotation,
                    const Eigen::Matrix3d& R_body_sensor, const Eigen::Matrix3d& covariance,
                    bool looks_forward);
  void say_turning_axis(const sensors::Mount& mount);
  SensorTime& time_of(const std::string& sensor);  // "camera", "lidar", "imu"

  Extrinsics found_;
};

}  // namespace maploop::extrinsics
