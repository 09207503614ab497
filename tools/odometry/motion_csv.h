// Motions as a table, one line a frame.
#pragma once

#include <filesystem>
#include <span>

#include "tools/odometry/stereo_runs.h"

namespace maploop::odometry {

// Columns, with a heading: frame, stamp and from (s), status; x, y, z (m) and rx, ry, rz (rotation
// vector, deg) of the body with their standard deviations; tracked, inliers; forward_speed (m/s)
// and azimuth_increment (deg, clockwise) with theirs; condition, parallax (px); milliseconds. Cells
// of a refused motion are empty but for its counts. Throws std::runtime_error naming the file when
// it cannot be written.
void write_csv(const std::filesystem::path& file, std::span<const Step> steps);

}  // namespace maploop::odometry
