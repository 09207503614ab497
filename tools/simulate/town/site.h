// Chooses where a drive takes place: the streets, the route through them, and the other cars there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "mapmatch/network_builder.h"
#include "msgs/local_frame.h"
#include "tools/simulate/scene/ray_scene.h"
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

// Centrelines have rounded corners and points 2 m apart; junctions closer to each other than a
// car's turn become one. Streets through tunnels, streets not open to cars, service roads and
// tracks are left out.
Streets streets_of(const mapmatch::MapExtract& map, const LocalFrame& frame);

// Returns at most `count` cars, each on its own route; a car that would come within 6 m of the
// vehicle or of another car is left out.
std::vector<VehicleMotion> make_traffic(const Streets& streets, const Terrain& terrain,
                                        const VehicleMotion& vehicle, std::size_t count,
                                        double seconds, std::uint64_t seed);

// Returns the poses of the cars, for the shapes of make_car(), at two times (s).
std::vector<MovingBody> bodies(const std::vector<VehicleMotion>& cars, double begin, double end);

}  // namespace maploop::simulate
