// Formats a calibration: as text for the terminal, as TOML, in KITTI's format, and as a page.
#pragma once

#include <string>
#include <vector>

#include "tools/calibrate/calibration.h"
#include "tools/calibrate/views.h"

namespace maploop::calibrate {

// An estimated parameter. They are in the order of Adjustment::sigma, named for instance "left.fx";
// rotations are in degrees.
struct Parameter {
  std::string name, unit;
  double value = 0.0, sigma = 0.0;
};
std::vector<Parameter> parameters_of(const StereoResult& result);

std::string to_text(const StereoResult& result, const std::vector<Unusable>& unusable);

// Returns the file that `[vehicle.camera] calibration` names
// (runtime/vehicle/drivers/stereo_rig_file.h); the standard deviations are comments.
std::string to_toml(const StereoResult& result);

// Returns KITTI's calib_cam_to_cam.txt for cameras 00 and 01.
std::string to_kitti(const StereoResult& result);

// Returns a page of pictures that only needs a browser. `pairs` holds the image files of the views,
// found by name. Images that can no longer be read are left out.
std::string to_page(const StereoResult& result, const std::vector<ImagePair>& pairs,
                    const std::vector<Unusable>& unusable);

}  // namespace maploop::calibrate
