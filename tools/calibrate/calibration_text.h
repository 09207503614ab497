// A calibration in words and numbers: for the terminal, as TOML, as KITTI's text.
#pragma once

#include <string>
#include <vector>

#include "tools/calibrate/calibration.h"
#include "tools/calibrate/image_pairs.h"

namespace maploop::calibrate {

// What was estimated, in the order of Adjustment::sigma, named "left.fx"; rotations in degrees.
struct Parameter {
  std::string name, unit;
  double value = 0.0, sigma = 0.0;
};
std::vector<Parameter> parameters_of(const StereoResult& result);

std::string to_text(const StereoResult& result, const std::vector<Unusable>& unusable);

// The file that `[camera] calibration` names (runtime/vehicle/stereo_rig_file.h), with the standard
// deviations as comments.
std::string to_toml(const StereoResult& result);

// KITTI's calib_cam_to_cam.txt of cameras 00 and 01.
std::string to_kitti(const StereoResult& result);

}  // namespace maploop::calibrate
