// A recorded drive as input of the matcher.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "mapmatch/vehicle_fix.h"
#include "msgs/input_limits.h"

namespace maploop::match {

using Track = std::vector<mapmatch::VehicleFix>;  // in order of increasing stamps

// Appends a fix read from the file `name`. Throws std::runtime_error if the track has too many.
inline void keep(const mapmatch::VehicleFix& fix, std::string_view name, Track& track) {
  if (track.size() == input_limits::fixes)
    throw std::runtime_error(std::string(name) + ": more than " +
                             std::to_string(input_limits::fixes) + " fixes; cut it into parts");
  track.push_back(fix);
}

}  // namespace maploop::match
