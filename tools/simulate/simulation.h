// A drive through a generated town, with everything its sensors saw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "msgs/local_frame.h"
#include "tools/simulate/imu_errors.h"
#include "tools/simulate/lidar_turn.h"
#include "tools/simulate/town_scene.h"

namespace maploop::simulate {

// Which sensors write; without cameras and LiDAR a drive is made many times faster than driven.
struct SimulatedSensors {
  bool camera = true, lidar = true, imu = true, gnss = true;
};

struct SimulationOptions {
  double seconds = 60.0;
  std::uint64_t seed = 1;
  ImuGrade imu = ImuGrade::tactical;
  unsigned threads = 0;  // 0: one for each processor; the drive does not depend on it
  Environment environment = Environment::town;
  SimulatedSensors sensors;
  double gnss_rate = 1.0;  // Hz
  Scanner scanner = Scanner::hdl_64e;
  // Whether nothing keeps the scanner's turns beside the images (calibration_errors.h); else each
  // image is taken in the middle of a turn, as on KITTI's car.
  bool free_scanner = true;
  // Scans as ranges instead of points, images of 86 grey levels: 5 MB a second instead of 25.
  bool compact = false;
  // OpenStreetMap file whose roads are driven; empty: a generated town's. The route is the shortest
  // way by these places, and on from the last one as the seed will; none: all of it.
  std::filesystem::path map;
  std::vector<Geodetic> route;
};

// Told after each frame how many of how many are written; returns whether to go on.
using FrameDone = std::function<bool(std::size_t done, std::size_t all)>;

// Makes the new folder `out`:
//   calib_*.txt        as of a day of KITTI's
//   town_sync          image_00, image_01, velodyne_points and oxts, 10 Hz each; gnss and
//                      gnss_one_frequency (gnss/gnss_recording.h)
//   town_extract       oxts at 100 Hz; names the same drive for a replay
//   map.osm            the road map, with a mapper's errors (road_map.h)
//   vehicle.toml       configuration of a replay: map, and all that it should know of the car
//   truth.tum          the left camera, from its first pose
//   driven_links.csv   the segments of the map that were driven, by frame
// It is complete or not there: until the end its name has ".partial" after it. Returns whether it
// was not broken off. Throws std::runtime_error naming a file that is there already or cannot be
// written, a map that cannot be read and a route that cannot be driven; std::invalid_argument for a
// drive shorter than a second or longer than an hour.
bool simulate_drive(const std::filesystem::path& out, const SimulationOptions& options,
                    const FrameDone& frame_done = {});

}  // namespace maploop::simulate
