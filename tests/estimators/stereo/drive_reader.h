// A recorded drive in KITTI's raw layout, read straight into stereo pairs.
#pragma once

#include <filesystem>
#include <vector>

#include "msgs/calibration.h"
#include "msgs/image.h"

namespace maploop::testing {

// P_rect_00, P_rect_01 and R_rect_00 of calib_cam_to_cam.txt, with calib_velo_to_cam.txt and
// calib_imu_to_velo.txt for T_body_cam. `folder` holds the three files.
StereoCalibration read_stereo_calibration(const std::filesystem::path& folder);

// The first `count` pairs of a drive (all where there are fewer). Throws std::runtime_error naming
// a file that cannot be read.
std::vector<StereoPair> read_stereo_pairs(const std::filesystem::path& drive,
                                          std::size_t count = 100000);

}  // namespace maploop::testing
