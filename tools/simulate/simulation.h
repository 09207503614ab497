// Simulates a drive and writes the data of all its sensors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "msgs/local_frame.h"
#include "tools/simulate/scene/town_scene.h"
#include "tools/simulate/sensors/inertial_unit.h"
#include "tools/simulate/sensors/lidar_turn.h"
#include "tools/simulate/sensors/simulated_car.h"

namespace maploop::simulate {

// Which sensors write data. Without cameras and LiDAR a drive is made many times faster than real
// time.
struct SimulatedSensors {
  bool camera = true, lidar = true, imu = true, gnss = true;
};

constexpr double most_seconds = 86400.0;  // s

struct SimulationOptions {
  double seconds = 60.0;  // 1 to most_seconds
  std::uint64_t seed = 1;
  ImuGrade imu = ImuGrade::tactical;
  unsigned threads = 0;  // 0: one for each processor; the drive does not depend on their number
  Environment environment = Environment::town;
  SimulatedSensors sensors;
  double gnss_rate = 1.0;  // Hz
  Scanner scanner = Scanner::hdl_64e;
  CarKind car = CarKind::standard;
  // True if the scanner's turns are not synchronized with the images (calibration_errors.h);
  // otherwise each image is taken in the middle of a turn, as on KITTI's car.
  bool free_scanner = true;
  // Writes scans as ranges instead of points, and images of 86 grey levels: 5 MB a second instead
  // of 25.
  bool compact = false;
  bool heights = false;  // writes the height of the ground as well
  // OpenStreetMap file whose roads are driven; if empty, a town is generated. The route is the
  // shortest one through these places and continues from the last one randomly; without places all
  // of it is random.
  std::filesystem::path map;
  std::vector<Geodetic> route;
};

// Called after each frame with the numbers of frames written and of all frames; returns whether to
// continue.
using FrameDone = std::function<bool(std::size_t done, std::size_t all)>;

// Makes the new folder `out`:
//   calib_*.txt        calibration files like those of a KITTI date
//   town_sync          image_00, image_01, velodyne_points and oxts, 10 Hz each; gnss and
//                      gnss_one_frequency (gnss/gnss_recording.h)
//   town_extract       oxts at 100 Hz; a replay of it reads the other sensors from town_sync
//   map.osm            the road map, with a mapper's errors (road_map.h)
//   heights            a tile of the ground's height with the errors of SRTM, if `heights` is set
//   vehicle.toml       configuration of a replay: the map, and all that there is to know of the car
//   vehicle_rough.toml the same for a drawn car, with what its owner knows (rough_description())
//   truth.tum          the left camera's poses, relative to its first one
//   driven_links.csv   the segments of the map that were driven, by frame
// The folder is complete or does not exist: its name has ".partial" appended until everything is
// written. Returns false if `frame_done` stopped the simulation. Throws std::runtime_error naming a
// folder that already exists or a file that cannot be written, a map that cannot be read or a route
// that cannot be driven; std::invalid_argument for a drive shorter than a second or longer than a
// day.
bool simulate_drive(const std::filesystem::path& out, const SimulationOptions& options,
                    const FrameDone& frame_done = {});

}  // namespace maploop::simulate
