// This file reads the calibration of KITTI's odometry benchmark.
#pragma once

#include <filesystem>

#include "msgs/calibration.h"
#include "sensors/replay/stereo_source.h"

namespace maploop::sensors {

// Reads calib.txt of KITTI's odometry benchmark: P0 and P1 of the rectified pair, and Tr, which
// takes the scanner to the camera, if it is there. The body's origin is the left camera. The size
// is that of the first of `images`. Throws std::runtime_error that names file and key.
VehicleCalibration read_sequence_calibration(const std::filesystem::path& file,
                                             const ImageFolder& images);

}  // namespace maploop::sensors
