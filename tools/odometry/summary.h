// Summarizes an odometry that ran alone, in some lines of text.
#pragma once

#include <string>
#include <vector>

#include "tools/odometry/lidar_run.h"
#include "tools/odometry/stereo_runs.h"

namespace maploop::odometry {

// Returns the value that this share of the values does not exceed.
double percentile(std::vector<double> values, double share);

// Return frames, distance, statuses and times. Of visual odometry also the times of its stages; of
// LiDAR odometry also the directions that scans did not determine. There is at least one step.
std::string summary(const std::vector<Step>& steps);
std::string summary(const std::vector<LidarStep>& steps);

}  // namespace maploop::odometry
