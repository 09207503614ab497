// The car that carries the simulated sensors.
#pragma once

#include <filesystem>

#include "msgs/calibration.h"

namespace maploop::simulate {

// Returns KITTI's camera (1242 x 375 pixels, 0.537 m baseline) and mounting of 2011-09-26, rounded.
VehicleCalibration test_car();

// Writes the calibration as KITTI's three files into a folder. Throws std::runtime_error naming the
// file.
void write_calibration(const std::filesystem::path& folder);

}  // namespace maploop::simulate
