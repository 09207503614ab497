// Writes motions of LiDAR odometry as a table, one line for each frame.
#pragma once

#include <filesystem>
#include <span>

#include "tools/odometry/lidar_run.h"

namespace maploop::odometry {

// Columns, with a heading: frame, stamp and from (s); status of the scan ("no scan" if none was
// used); source of the published motion; its x, y, z (m) and rx, ry, rz (rotation vector, deg) with
// their standard deviations; tracked, inliers, iterations; degenerate (directions joined by '+');
// seed_translation (m) and seed_rotation (deg), by which the registration changed its seed;
// milliseconds. Cells of a motion that is not ok are empty. Throws std::runtime_error naming the
// file if it cannot be written.
void write_lidar_csv(const std::filesystem::path& file, std::span<const LidarStep> steps);

}  // namespace maploop::odometry
