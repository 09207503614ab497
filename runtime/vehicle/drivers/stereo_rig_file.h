// Reads and writes the calibration of raw cameras as a file.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "sensors/camera/stereo_rig.h"

namespace maploop::vehicle {

// Reads TOML as `maploop calibrate` writes it, or KITTI's calib_cam_to_cam.txt if the name ends
// with .txt. TOML has these keys:
//   width, height                 px, of the raw images
//   [left] [right]                fx fy cx cy (px), k1 k2 p1 p2 k3, and
//     direction                   "undistorted_to_distorted" (OpenCV, ROS, Kalibr; the default) or
//                                 "distorted_to_undistorted" (converted as it is read)
//   [extrinsics]                  R_right_left (nine numbers, row by row), t_right_left (m)
//   [rectification]               R_rect_left, R_rect_right, width, height, fx, fy, cx, cy,
//                                 baseline (m)
// Where the cameras are on the vehicle is said by [vehicle.camera] of the configuration.
// Throws std::runtime_error naming file, line and key of what is wrong, also of an unknown key.
sensors::StereoRig read_stereo_rig(const std::filesystem::path& file);

// Returns the text that read_stereo_rig() reads. `comments` has the comment to be written after a
// key, which is named as in "left.fx".
std::string to_toml(const sensors::StereoRig& rig,
                    const std::map<std::string, std::string>& comments = {});

}  // namespace maploop::vehicle
