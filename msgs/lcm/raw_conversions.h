// This file converts raw sensors and their calibration to LCM types, and back to the same bits. (It
// is separate from conversions.h because only logs contain them.)
#pragma once

#include <maploop_lcm/calibration_t.hpp>
#include <maploop_lcm/lidar_scan_t.hpp>
#include <maploop_lcm/stereo_pair_t.hpp>

#include "msgs/calibration.h"
#include "msgs/image.h"
#include "msgs/lidar_scan.h"

namespace maploop {

maploop_lcm::calibration_t to_lcm(const VehicleCalibration& calibration);  // the caller sets utime
maploop_lcm::stereo_pair_t to_lcm(const StereoPair& pair);
maploop_lcm::lidar_scan_t to_lcm(const LidarScan& scan);

VehicleCalibration from_lcm(const maploop_lcm::calibration_t& message);
// These throw std::invalid_argument if a size contradicts the rest. The output's buffers are
// reused.
void from_lcm(const maploop_lcm::stereo_pair_t& message, StereoPair& pair);
void from_lcm(const maploop_lcm::lidar_scan_t& message, LidarScan& scan);

}  // namespace maploop
