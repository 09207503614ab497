// What the estimators did not use, by their own reasons.
#pragma once

#include <vector>

#include "estimators/fusion/reduced_imu_filter.h"
#include "msgs/diagnostics.h"
#include "runtime/vehicle/lidar_stage.h"
#include "runtime/vehicle/mapmatch_stage.h"
#include "runtime/vehicle/ppp_stage.h"
#include "runtime/vehicle/stereo_stage.h"

namespace maploop::vehicle {

// `lidar`, `ppp`, `mapmatch`: nullptr where there is none. Those that happened, in the order of the
// reasons.
std::vector<RefusalCount> refusals(const StereoStage& stereo, const LidarStage* lidar,
                                   const PppStage* ppp, const fusion::FilterStatus& filter,
                                   const MapMatchStage* mapmatch);

}  // namespace maploop::vehicle
