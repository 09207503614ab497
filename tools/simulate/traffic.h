// Other cars that drive through the town.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/simulate/ray_scene.h"
#include "tools/simulate/vehicle_motion.h"

namespace maploop::simulate {

// At most `count` cars, each on a route of its own; one that would come within 6 m of the vehicle
// or of another is left out.
std::vector<VehicleMotion> make_traffic(const Streets& streets, const Terrain& terrain,
                                        const VehicleMotion& vehicle, std::size_t count,
                                        double seconds, std::uint64_t seed);

// Where the cars are, as make_car's shapes, from one time (s) to another.
std::vector<MovingBody> bodies(const std::vector<VehicleMotion>& cars, double begin, double end);

}  // namespace maploop::simulate
