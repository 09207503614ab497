// Chooses where a drive takes place: the streets and the route through them.
#pragma once

#include <vector>

#include "msgs/local_frame.h"
#include "tools/simulate/sensors/vehicle_motion.h"
#include "tools/simulate/simulation.h"
#include "tools/simulate/town/streets.h"

namespace maploop::simulate {

struct Site {
  LocalFrame frame;
  Streets streets;
  std::vector<DirectedStreet> route;
};

// Returns a generated town, or the part of a map along the route. Throws std::runtime_error naming
// the map file, or the place of the route that has no road nearby.
Site choose_site(const SimulationOptions& options);

VehicleMotion drive_along(const Streets& streets, const std::vector<DirectedStreet>& route,
                          const Terrain& terrain, double seconds, std::uint64_t seed);

}  // namespace maploop::simulate
