// The stereo odometry's parameters described: [stereo] of the configuration.
#pragma once

#include "estimators/stereo/parameters.h"
#include "msgs/parameter.h"

namespace maploop::stereo {

ParameterTable<StereoParameters> parameter_table(const StereoParameters&);

}  // namespace maploop::stereo
