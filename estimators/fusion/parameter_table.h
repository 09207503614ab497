// These tables describe the parameters of the filter and of its guard: [fusion] and [guard] of the
// configuration.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/guard_parameters.h"
#include "msgs/parameter.h"

namespace maploop::fusion {

ParameterTable<FusionParameters> parameter_table(const FusionParameters&);
ParameterTable<GuardParameters> parameter_table(const GuardParameters&);

}  // namespace maploop::fusion
