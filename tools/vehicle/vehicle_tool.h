// This is what `maploop vehicle` does with a description of a vehicle (msgs/vehicle_description.h).
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/vehicle_description.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "sensors/camera/stereo_rig.h"

namespace maploop::vehicle_tool {

// Asks for each value on `out`, and reads answers "VALUE" or "VALUE SIGMA", a line each; an empty
// one leaves the value unknown. A wrong answer is asked for again. Throws std::runtime_error naming
// the question before which the answers end.
VehicleDescription ask(std::istream& in, std::ostream& out);

struct Findings {
  std::vector<std::string> warnings;
  std::vector<std::string> assumed;  // what is not given, a line for each table
};

// Says what is implausible or missing in a configuration that was read. Throws std::runtime_error
// if a calibration file that it names is wrong.
Findings look_at(const vehicle::VehicleConfig& config);

// Draws a vehicle from above and from its right side, with the sensors that the file describes, as
// SVG. An axis is 0.3 m long: x red, y green, z blue. Ellipses show one standard deviation.
std::string drawing(const vehicle::VehicleConfig& config);

struct Converted {
  VehicleDescription description;
  std::optional<sensors::StereoRig> cameras;  // raw ones, which need a file of their own
  std::string note;                           // about the axes, for whoever reads the file
};

// These read the calibration of a dataset. All throw std::runtime_error naming the file and the
// key.
// - KITTI raw: the folder of a day, or of one of its drives
//   (calib_{cam_to_cam,velo_to_cam,imu_to_velo}.txt).
// - KITTI-360: the folder `calibration` (calib_cam_to_pose.txt, calib_cam_to_velo.txt,
//   perspective.txt), or the folder that has it. Its IMU has x forward, y right, z down (Liao, Xie,
//   Geiger, "KITTI-360", PAMI 2022).
// - EuRoC: the folder mav0, or the folder that has it (cam0, cam1: sensor.yaml with T_BS; Burri et
//   al., IJRR 2016). Axes of the body are those of B that come nearest to a left camera that looks
//   forward.
Converted from_kitti(const std::filesystem::path& folder);
Converted from_kitti_360(const std::filesystem::path& folder);
Converted from_euroc(const std::filesystem::path& folder);

}  // namespace maploop::vehicle_tool
