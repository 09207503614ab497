// What parameters can be used.
#pragma once

#include "estimators/lidar/parameters.h"

namespace maploop::lidar {

// Throws std::invalid_argument naming the value.
void validate(const LidarParameters& parameters);

}  // namespace maploop::lidar
