// These tables describe the parameters of the filter, of its guard and of its protection levels:
// [fusion], [guard] and [protection] of the configuration.
#pragma once

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/guard_parameters.h"
#include "estimators/fusion/protection_parameters.h"
#include "msgs/parameter.h"

namespace maploop::fusion {

ParameterTable<FusionParameters> parameter_table(const FusionParameters&);
ParameterTable<GuardParameters> parameter_table(const GuardParameters&);
ParameterTable<ProtectionParameters> parameter_table(const ProtectionParameters&);

}  // namespace maploop::fusion
