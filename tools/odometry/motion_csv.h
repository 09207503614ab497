// Writes motions as a table, one line for each frame.
#pragma once

#include <filesystem>
#include <span>

#include "tools/odometry/lidar_run.h"
#include "tools/odometry/stereo_runs.h"

namespace maploop::odometry {

// Both tables have a heading and these columns: frame, stamp and from (s), status; x, y, z (m) and
// rx, ry, rz (rotation vector, deg) of the body with their standard deviations; tracked, inliers;
// milliseconds. Cells of a motion that is not ok are empty. Throws std::runtime_error naming the
// file if it cannot be written.

// Adds forward_speed (m/s) and azimuth_increment (deg, clockwise) with their standard deviations,
// condition, and parallax (px).
void write_csv(const std::filesystem::path& file, std::span<const Step> steps);

// Has the status of the scan ("no scan" if none was used). Adds the source of the published motion;
// iterations, degenerate (directions joined by '+'), seed_translation (m) and seed_rotation (deg),
// by which the registration changed its seed.
void write_csv(const std::filesystem::path& file, std::span<const LidarStep> steps);

}  // namespace maploop::odometry
