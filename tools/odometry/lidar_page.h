// The way of a LiDAR odometry and what it saw, as a page.
#pragma once

#include <string>
#include <vector>

#include "tools/odometry/lidar_run.h"
#include "tools/odometry/point_cloud.h"

namespace maploop::odometry {

// Frames, way, statuses, directions that scans did not determine, times; some lines of text.
std::string summary(const std::vector<LidarStep>& steps);

// A page with that, the cloud from above with the path in it, and the heights along the way.
std::string lidar_page(const std::string& heading, const std::vector<LidarStep>& steps,
                       const PointCloud& cloud);

}  // namespace maploop::odometry
