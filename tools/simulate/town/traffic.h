// Simulates other cars that drive through the town.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/simulate/scene/ray_scene.h"
#include "tools/simulate/sensors/vehicle_motion.h"

namespace maploop::simulate {

// Returns at most `count` cars, each on its own route; a car that would come within 6 m of the
// vehicle or of another car is left out.
std::vector<VehicleMotion> make_traffic(const Streets& streets, const Terrain& terrain,
                                        const VehicleMotion& vehicle, std::size_t count,
                                        double seconds, std::uint64_t seed);

// Returns the poses of the cars, for the shapes of make_car(), at two times (s).
std::vector<MovingBody> bodies(const std::vector<VehicleMotion>& cars, double begin, double end);

}  // namespace maploop::simulate
