// Formats a calibration: as text for the terminal, as TOML, and in KITTI's format.
#pragma once

#include <string>
#include <vector>

#include "tools/calibrate/calibration.h"
#include "tools/calibrate/image_pairs.h"

namespace maploop::calibrate {

// An estimated parameter. They are in the order of Adjustment::sigma, named for instance "left.fx";
// rotations are in degrees.
struct Parameter {
  std::string name, unit;
  double value = 0.0, sigma = 0.0;
};
std::vector<Parameter> parameters_of(const StereoResult& result);

std::string to_text(const StereoResult& result, const std::vector<Unusable>& unusable);

// Returns the file that `[camera] calibration` names (runtime/vehicle/drivers/stereo_rig_file.h);
// the standard deviations are comments.
std::string to_toml(const StereoResult& result);

// Returns KITTI's calib_cam_to_cam.txt for cameras 00 and 01.
std::string to_kitti(const StereoResult& result);

}  // namespace maploop::calibrate
