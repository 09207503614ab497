// A recorded drive as the matcher takes it.
#pragma once

#include <vector>

#include "mapmatch/vehicle_fix.h"

namespace maploop::match {

using Track = std::vector<mapmatch::VehicleFix>;  // by rising stamps

}  // namespace maploop::match
