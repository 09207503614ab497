// The LiDAR odometry's parameters described: [lidar] of the configuration.
#pragma once

#include "estimators/lidar/parameters.h"
#include "msgs/parameter.h"

namespace maploop::lidar {

ParameterTable<LidarParameters> parameter_table(const LidarParameters&);

}  // namespace maploop::lidar
