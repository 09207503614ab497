// Faults of a LiDAR: what they do to a scan. Random numbers depend only on the seed and the stamp.
#pragma once

#include <cstdint>

#include "msgs/lidar_scan.h"
#include "runtime/vehicle/faults/strike.h"

namespace maploop::vehicle {

// Sets every measured number to NaN.
void fill_with_nan(LidarScan& scan);

// Adds white noise of this standard deviation (m) to each range.
void roughen(LidarScan& scan, double sigma, std::uint64_t seed);

// Shows what the scanner sees after it has been turned to the left by `angle` (rad).
void turn(LidarScan& scan, double angle);

// Removes the points of the sector of this width (rad) that lies ahead.
void block(LidarScan& scan, double width);

// Makes the share `drops` of the returns come from 1 to 6 m along their beams, and loses the same
// share of those beyond 20 m.
void rain_on(LidarScan& scan, double drops, std::uint64_t seed);

// Applies a fault that changes scans; other kinds leave them as they are.
void distort(LidarScan& scan, const Strike& strike);

}  // namespace maploop::vehicle
