// Shows the path of a LiDAR odometry and the scanned surfaces as a page.
#pragma once

#include <string>
#include <vector>

#include "tools/odometry/lidar_run.h"
#include "tools/odometry/point_cloud.h"

namespace maploop::odometry {

// Returns a page with the summary (summary.h), the cloud from above with the path in it, and the
// heights along the way.
std::string lidar_page(const std::string& heading, const std::vector<LidarStep>& steps,
                       const PointCloud& cloud);

}  // namespace maploop::odometry
