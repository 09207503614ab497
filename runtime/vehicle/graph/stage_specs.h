// The threads of the vehicle's graph, and the paths through it with a deadline: what runs when,
// when its result becomes available, and by when it has to be done. GRAPH.md shows them.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "msgs/time.h"
#include "runtime/core/periodic.h"

namespace maploop::vehicle {

using std::chrono::milliseconds;

// How many bytes a stage's estimator holds at most, apart from its thread's stack.
struct WorkingMemory {
  std::size_t fixed = 0;
  std::size_t per_pixel = 0;  // of one image of a pair

  constexpr std::size_t bytes(std::size_t pixels) const { return fixed + per_pixel * pixels; }
};

// One thread. Rates, periods and budgets are of data time; the deadline is of the machine's clock.
struct StageSpec {
  std::string_view name;
  std::string_view runs;
  std::string_view released;  // what starts one step of it
  Duration period{};          // of a thread with a fixed rate, else 0
  Duration phase{};           // offset of its ticks within the period
  // What a live run does with ticks that fall behind. A replay catches up with every tick, because
  // results derive from data alone: the same bits on each run.
  runtime::Overrun overrun = runtime::Overrun::catch_up;
  // A stage with two inputs holds a sample of one this long (from the sample's `available`) for the
  // matching sample of the other; then it processes the sample without a match.
  Duration patience{};
  Duration budget{};      // the result becomes available this long after the release
  Duration deadline{};    // from release to result; 0: none
  double min_rate = 0.0;  // Hz; HEALTH reports a lower rate; 0: not watched
  double max_rate = 0.0;  // Hz; HEALTH reports a higher rate
  bool expected = false;  // a sensor that reports list even if the vehicle lacks it
  bool saved = false;     // a part of snapshots
  WorkingMemory memory{};
  std::string_view scheduled_as = {};  // its key of [scheduling], if that is not its name
  bool polls = false;  // looks into its rings now and then: no producer pays for waking it
};

namespace stages {
// A sensor's driver. HEALTH names it if the vehicle lacks it and `min_rate` is above 0.
constexpr StageSpec expected_sensor(std::string_view name, double min_rate, double max_rate) {
  return {.name = name,
          .runs = "driver",
          .released = "sensor",
          .min_rate = min_rate,
          .max_rate = max_rate,
          .expected = true};
}
constexpr StageSpec optional_sensor(std::string_view name, std::string_view scheduled_as = "") {
  return {.name = name,
          .runs = "driver",
          .released = "sensor",
          .max_rate = 1000.0,
          .scheduled_as = scheduled_as};
}
// The drivers of a log without images replay its odometry in place of camera, stereo and lidar.
constexpr StageSpec logged(std::string_view name, double min_rate) {
  return {.name = name,
          .runs = "driver of a log without images",
          .released = "sensor",
          .min_rate = min_rate,
          .max_rate = 40.0,
          .scheduled_as = "odometry"};
}

inline constexpr StageSpec camera = expected_sensor("camera", 5.0, 40.0);
inline constexpr StageSpec velodyne = expected_sensor("velodyne", 5.0, 21.0);
inline constexpr StageSpec imu = expected_sensor("imu", 5.0, 1000.0);
inline constexpr StageSpec gnss = expected_sensor("gnss", 0.5, 21.0);
inline constexpr StageSpec corrections = optional_sensor("corrections", "gnss");
inline constexpr StageSpec wheel = optional_sensor("wheel");
inline constexpr StageSpec reference = expected_sensor("reference", 0.0, 1000.0);
inline constexpr StageSpec odometry = logged("odometry", 5.0);
inline constexpr StageSpec visual_log = logged("visual log", 0.0);
inline constexpr StageSpec lidar_log = logged("lidar log", 0.0);

inline constexpr StageSpec stereo{.name = "stereo",
                                  .runs = "visual odometry",
                                  .released = "image pair",
                                  .budget = milliseconds(50),
                                  .deadline = milliseconds(50),
                                  .min_rate = 5.0,
                                  .max_rate = 40.0,
                                  .saved = true,
                                  .memory = {.per_pixel = 40}};
inline constexpr StageSpec lidar{.name = "lidar",
                                 .runs = "visual-LiDAR odometry",
                                 .released = "scan and its visual motion",
                                 // A turn of 0.1 s ends at most 45 ms after the odometry of an
                                 // image at its start; the remaining 15 ms are for deliveries.
                                 .patience = milliseconds(60),
                                 .budget = milliseconds(60),
                                 .deadline = milliseconds(60),
                                 .min_rate = 5.0,
                                 .max_rate = 40.0,
                                 .saved = true,
                                 .memory = {.fixed = 32'000'000}};
inline constexpr StageSpec ppp{.name = "ppp",
                               .runs = "precise point positioning",
                               .released = "GNSS epoch",
                               .budget = milliseconds(10),
                               .deadline = milliseconds(10),
                               .min_rate = 0.5,
                               .max_rate = 21.0,
                               .saved = true,
                               .memory = {.fixed = 5'000'000}};
inline constexpr StageSpec fusion{.name = "fusion",
                                  .runs = "reduced-IMU filter",
                                  .released = "its period",
                                  .period = milliseconds(10),
                                  .overrun = runtime::Overrun::skip,
                                  .budget = milliseconds(1),
                                  .deadline = milliseconds(2),
                                  .min_rate = 95.0,
                                  .max_rate = 105.0,
                                  .saved = true,
                                  // Three filters, once the map feeds back.
                                  .memory = {.fixed = 24'000'000}};
inline constexpr StageSpec mapmatch{
    .name = "mapmatch",
    .runs = "map matching",
    .released = "its period",
    .period = milliseconds(100),
    .phase = fusion.budget,  // when the state of a fusion tick becomes available
    .overrun = runtime::Overrun::skip,
    .budget = milliseconds(2),
    .deadline = milliseconds(2),
    .min_rate = 9.5,
    .max_rate = 10.5,
    .saved = true,
    .memory = {.fixed = 60'000}};
inline constexpr StageSpec publisher{
    .name = "publisher", .runs = "LCM, log", .released = "polls", .polls = true};
inline constexpr StageSpec health{.name = "health",
                                  .runs = "watchdog, histograms",
                                  .released = "its period",
                                  .period = std::chrono::seconds(1),
                                  .phase = milliseconds(5),  // between two ticks of the fusion
                                  .overrun = runtime::Overrun::skip};
inline constexpr StageSpec preview{
    .name = "preview", .runs = "pictures for people", .released = "its rate"};
inline constexpr StageSpec player{
    .name = "player", .runs = "keys, commands of a replay", .released = "polls"};
inline constexpr StageSpec snapshot{
    .name = "snapshot", .runs = "joins the saved stages", .released = "their parts"};

inline constexpr std::array all{camera,    velodyne,  imu,      gnss,       corrections,
                                wheel,     reference, odometry, visual_log, lidar_log,
                                stereo,    lidar,     ppp,      fusion,     mapmatch,
                                publisher, health,    player,   snapshot,   preview};
}  // namespace stages

// From a sensor's stamp to the state that holds it. The deadline is the sum of what may pass on the
// way: the sensor's own delay, the budgets, the wait for a scan, one period of waiting for the
// tick, and its deadline.
struct Path {
  std::string_view name;
  Duration deadline;
};

namespace paths {
inline constexpr Duration camera_delay = milliseconds(10);  // exposure and readout
inline constexpr Duration imu_delay = milliseconds(62);     // filters inside the sensor, delivery
inline constexpr Path camera{"camera stamp -> state",
                             camera_delay + stages::stereo.budget + stages::lidar.patience +
                                 stages::lidar.budget + stages::fusion.period +
                                 stages::fusion.deadline};
inline constexpr Path imu{"imu stamp -> state",
                          imu_delay + stages::fusion.period + stages::fusion.deadline};
inline constexpr std::array all{camera, imu};
}  // namespace paths
}  // namespace maploop::vehicle
