// Writes motions as a table, one line for each frame.
#pragma once

#include <filesystem>
#include <span>

#include "tools/odometry/stereo_runs.h"

namespace maploop::odometry {

// Columns, with a heading: frame, stamp and from (s), status; x, y, z (m) and rx, ry, rz (rotation
// vector, deg) of the body with their standard deviations; tracked, inliers; forward_speed (m/s)
// and azimuth_increment (deg, clockwise) with their standard deviations; condition, parallax (px);
// milliseconds. Cells of a refused motion are empty, except for its counts, condition, parallax and
// time. Throws std::runtime_error naming the file if it cannot be written.
void write_csv(const std::filesystem::path& file, std::span<const Step> steps);

// "frame,stamp,from" of a line; without a motion `from` is empty.
std::string stamp_cells(std::uint64_t frame, const RelativeMotion& motion);

// ",x,y,z" in m, the rotation vector in deg and the standard deviations of both; commas alone
// without a motion.
std::string motion_cells(const RelativeMotion& motion);

}  // namespace maploop::odometry
