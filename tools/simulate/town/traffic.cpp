#include "tools/simulate/town/traffic.h"

#include <algorithm>
#include <memory>

#include "tools/simulate/random.h"
#include "tools/simulate/town/route.h"

namespace maploop::simulate {
namespace {

bool meet(const VehicleMotion& a, const VehicleMotion& b, double seconds) {
  constexpr double step = 0.1, closest = 6.0;
  for (double t = 0.0; t < seconds; t += step)
    if ((a.position(t) - b.position(t)).norm() < closest) return true;
  return false;
}

}  // namespace

std::vector<VehicleMotion> make_traffic(const Streets& streets, const Terrain& terrain,
                                        const VehicleMotion& vehicle, std::size_t count,
                                        double seconds, std::uint64_t seed) {
  Random random(seed, 13);
  std::vector<VehicleMotion> cars;
  const Directions directions(streets);
  const double way = longest_drive(seconds, fastest(streets));
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t own = mix(seed, 100 + i);
    const std::size_t start = random.below(static_cast<std::uint32_t>(streets.junctions.size()));
    if (!directions.has_exit(start)) continue;
    const auto route = make_route(streets, start, way, own);
    auto path = std::make_shared<LanePath>(streets, route, own);
    auto profile = std::make_shared<SpeedProfile>(*path, streets, seconds, own);
    VehicleMotion car(std::move(path), std::move(profile), terrain, own);
    const bool alone = std::none_of(cars.begin(), cars.end(), [&](const VehicleMotion& other) {
      return meet(car, other, seconds);
    });
    if (alone && !meet(car, vehicle, seconds)) cars.push_back(std::move(car));
  }
  return cars;
}

std::vector<MovingBody> bodies(const std::vector<VehicleMotion>& cars, double begin, double end) {
  // From the body frame (above the rear axle at the height of an inertial unit) to the frame of
  // make_car()'s shape (its middle, on the road).
  const Eigen::Translation3d T_body_shape(1.3, 0.0, -VehicleMotion::origin_height);
  std::vector<MovingBody> result;
  for (const VehicleMotion& car : cars)
    result.push_back({car.pose(begin) * T_body_shape, car.pose(end) * T_body_shape});
  return result;
}

}  // namespace maploop::simulate
