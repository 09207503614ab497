// A recorded drive as the matcher takes it.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mapmatch/vehicle_fix.h"
#include "msgs/input_limits.h"

namespace maploop::match {

using Track = std::vector<mapmatch::VehicleFix>;  // by rising stamps

// Adds a fix of the file of that name. Throws std::runtime_error where it has too many.
inline void keep(const mapmatch::VehicleFix& fix, std::string_view name, Track& track) {
  if (track.size() == input_limits::fixes)
    throw std::runtime_error(std::string(name) + ": more than " +
                             std::to_string(input_limits::fixes) + " fixes; cut it into parts");
  track.push_back(fix);
}

}  // namespace maploop::match
