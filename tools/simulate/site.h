// Where a drive takes place: streets and the route through them.
#pragma once

#include <vector>

#include "msgs/local_frame.h"
#include "tools/simulate/simulation.h"
#include "tools/simulate/streets.h"
#include "tools/simulate/vehicle_motion.h"

namespace maploop::simulate {

struct Site {
  LocalFrame frame;
  Streets streets;
  std::vector<DirectedStreet> route;
};

// A generated town, or what lies along the route on a map. Throws std::runtime_error naming the
// file, or the place of the route that no road is near.
Site choose_site(const SimulationOptions& options);

VehicleMotion drive_along(const Streets& streets, const std::vector<DirectedStreet>& route,
                          const Terrain& terrain, double seconds, std::uint64_t seed);

}  // namespace maploop::simulate
