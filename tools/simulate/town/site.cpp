#include "tools/simulate/town/site.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "mapmatch/osm_reader.h"
#include "msgs/frames.h"
#include "tools/simulate/random.h"
#include "tools/simulate/town/route.h"

namespace maploop::simulate {
namespace {

constexpr double sea_to_ground = 115.0;  // m, ground height on maps too; sun and sky do not change
const Geodetic town_origin{radians(49.01), radians(8.43), sea_to_ground};

Site town(const SimulationOptions& options) {
  Site site{LocalFrame(town_origin), make_town(options.seed), {}};
  // The drive starts in the middle of the town, so that there are buildings on all sides.
  const std::size_t begin = nearest_junction(site.streets, Eigen::Vector2d::Zero());
  site.route = make_route(site.streets, begin, longest_drive(options.seconds), options.seed);
  return site;
}

// Returns a junction of the map from which a route can continue forever.
std::size_t draw_start(const Streets& streets, const SimulationOptions& options) {
  const Directions directions(streets);
  Random random(options.seed, 30);
  constexpr int tries = 10'000;
  for (int i = 0; i < tries && !streets.junctions.empty(); ++i) {
    const std::size_t junction = random.below(static_cast<std::uint32_t>(streets.junctions.size()));
    if (directions.has_exit(junction)) return junction;
  }
  throw std::runtime_error("the map '" + options.map.string() +
                           "' has no roads that lead round in a circle; take a larger one");
}

std::vector<std::size_t> junctions_of(const Streets& streets, const LocalFrame& frame,
                                      const SimulationOptions& options) {
  constexpr double farthest = 300.0;  // m
  std::vector<std::size_t> via;
  for (const Geodetic& place : options.route) {
    const Eigen::Vector2d p =
        frame.to_enu({place.latitude, place.longitude, sea_to_ground}).head<2>();
    via.push_back(nearest_junction(streets, p));
    const double distance = (streets.junctions[via.back()] - p).norm();
    if (distance > farthest)
      throw std::runtime_error("place " + std::to_string(via.size()) + " of the route is " +
                               std::to_string(static_cast<int>(distance)) +
                               " m from the nearest junction of '" + options.map.string() + "'");
  }
  return via;
}

Site on_map(const SimulationOptions& options) {
  const mapmatch::MapExtract map = mapmatch::read_osm(options.map);
  Geodetic origin{radians(map.nodes.front().latitude), radians(map.nodes.front().longitude),
                  sea_to_ground};
  if (!options.route.empty())
    origin = {options.route.front().latitude, options.route.front().longitude, sea_to_ground};
  Streets all = streets_of(map, LocalFrame(origin));
  if (options.route.empty()) {
    // The frame's origin is moved to the start: far from its origin the plane deviates from the
    // earth's surface.
    const Eigen::Vector2d start = all.junctions[draw_start(all, options)];
    origin = LocalFrame(origin).to_geodetic({start.x(), start.y(), 0.0});
    origin.height = sea_to_ground;
    all = streets_of(map, LocalFrame(origin));
  }
  const LocalFrame frame(origin);
  if (all.streets.empty())
    throw std::runtime_error("the map '" + options.map.string() + "' has no roads to drive on");
  std::vector<std::size_t> via = junctions_of(all, frame, options);
  if (via.empty()) via = {nearest_junction(all, Eigen::Vector2d::Zero())};
  const double metres = longest_drive(options.seconds, fastest(all));
  std::vector<DirectedStreet> route = make_route(all, via, metres, options.seed);
  // The car does not drive at the limit all the time, so that only the streets that it reaches are
  // built.
  const VehicleMotion motion =
      drive_along(all, route, Terrain(options.seed), options.seconds, options.seed);
  const auto& stretches = motion.path().stretches();
  constexpr double ahead = 200.0;  // m
  std::size_t count = 1;
  while (count < stretches.size() &&
         stretches[count - 1].end < motion.way(options.seconds + 2.0) + ahead)
    ++count;
  route.resize(count);
  constexpr double beside = 150.0;  // m
  Corridor part = corridor(all, route, beside);
  return {frame, std::move(part.streets), std::move(part.route)};
}

bool meet(const VehicleMotion& a, const VehicleMotion& b, double seconds) {
  constexpr double step = 0.1, closest = 6.0;
  for (double t = 0.0; t < seconds; t += step)
    if ((a.position(t) - b.position(t)).norm() < closest) return true;
  return false;
}

}  // namespace

Site choose_site(const SimulationOptions& options) {
  return options.map.empty() ? town(options) : on_map(options);
}

VehicleMotion drive_along(const Streets& streets, const std::vector<DirectedStreet>& route,
                          const Terrain& terrain, double seconds, std::uint64_t seed) {
  auto path = std::make_shared<LanePath>(streets, route, seed);
  auto profile = std::make_shared<SpeedProfile>(*path, streets, seconds, seed);
  return {std::move(path), std::move(profile), terrain, seed};
}

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
