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
  // These delays are of a sensor's stamps against the camera's; `more` (s) is added to the delay
  // that is described.
  void set_unit_delay(double more, double sigma);
  void set_lidar_delay(double more, double sigma);
  void set_forward(const std::string& sensor, const Travel& travel);  // "camera", "lidar"
  // From the camera's place, which is described.
  void set_lidar_position(const HandEye& eye, const JointRotation& rotation);
  void set_mount(const sensors::Mount& mount);

 private:
  struct Change {
    const char* key;
    double &value, &sigma;  // in the description
    double new_value, new_sigma;
  };
  void put(const std::string& sensor, const char* unit, double limit, const Change& change);
  void put_rotation(const std::string& sensor, SensorRotation& rotation,
                    const Eigen::Matrix3d& R_body_sensor, const Eigen::Matrix3d& covariance,
                    bool looks_forward);
  void put_delay(const std::string& sensor, SensorTime& time, double more, double sigma);

  Extrinsics found_;
};

}  // namespace maploop::extrinsics
