#include "tools/simulate/drive.h"

#include <chrono>
#include <utility>

#include "tools/simulate/random.h"
#include "tools/simulate/scene/town_scene.h"
#include "tools/simulate/town/site.h"

namespace maploop::simulate {
namespace {

constexpr double first_frame = 0.1;  // s
constexpr std::size_t car_count = 30;

// Another seed also means another time of day, so that noise that depends on the stamp, and the
// ionosphere, differ.
Time start_of(std::uint64_t seed) {
  constexpr std::uint64_t half_day = 43'200;  // s
  return parse_time("2026-05-04 06:00:00.0") + std::chrono::seconds(mix(seed, 31) % half_day);
}

}  // namespace

Drive::Drive(const SimulationOptions& options) : Drive(options, choose_site(options)) {}

Drive::Drive(const SimulationOptions& options, Site site)
    : start(start_of(options.seed)),
      frame(site.frame),
      streets(std::move(site.streets)),
      terrain(options.seed),
      index(streets, 2.5),
      appearance(index),
      car(simulated_car(options.car, options.seed)),
      calibration(calibration_of(car)),
      errors(calibration_errors(options.seed)),
      motion(drive_along(streets, site.route, terrain, options.seconds, options.seed)),
      traffic(make_traffic(streets, terrain, motion, car_count, options.seconds, options.seed)) {
  motion.set_body(car.T_car_body);
  std::vector<Mesh> shapes;
  Random random(options.seed, 16);
  for (std::size_t i = 0; i < traffic.size(); ++i) {
    shapes.push_back(make_car(static_cast<float>(random.uniform(0.05, 0.7)),
                              static_cast<std::uint32_t>(1000 + i)));
  }
  world.emplace(make_town_scene(streets, index, terrain, options.seed, options.environment),
                std::move(shapes));
  for (double t = first_frame; t + 0.5 * frame_interval <= options.seconds; t += frame_interval)
    times.push_back(t);
  double lead = 0.5 * frame_interval;  // s from the start of a turn to its image
  if (options.free_scanner) {
    lead = frame_interval - errors.scanner_phase;
    turn_time = frame_interval * (1.0 + errors.scanner_drift);
  }
  for (std::size_t i = 0; i < times.size(); ++i)
    turns.push_back(first_frame - lead + static_cast<double>(i) * turn_time);
}

}  // namespace maploop::simulate
