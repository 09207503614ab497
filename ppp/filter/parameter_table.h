// The parameters of the PPP filter described: keys of [ppp] of the configuration.
#pragma once

#include "msgs/parameter.h"
#include "ppp/filter/parameters.h"

namespace maploop::ppp {

ParameterTable<PppParameters> parameter_table(const PppParameters&);
ParameterTable<GroundParameters> parameter_table(const GroundParameters&);  // [ppp.ground]

}  // namespace maploop::ppp
