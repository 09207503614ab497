// Writes the files of the car's GNSS receiver and the orbit and clock products.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "msgs/local_frame.h"
#include "msgs/time.h"
#include "tools/simulate/scene/ray_scene.h"
#include "tools/simulate/sensors/vehicle_motion.h"

namespace maploop::simulate {

struct GnssSetting {
  const VehicleMotion& motion;
  const Eigen::Vector3d& antenna;             // m, in the body frame
  const std::vector<VehicleMotion>& traffic;  // the moving bodies of `world`
  const World& world;
  const LocalFrame& frame;
  Time start;
  double seconds;
  double rate;  // Hz
  std::uint64_t seed;
};

// Makes the folders `gnss` and `gnss_one_frequency` with these files:
// - observations.rnx: RINEX 3.04 of GPS (L1 C/A and L2C) and Galileo (E1 and E5a); with one
//   frequency L1 C/A and E1 alone,
// - navigation.rnx: the broadcast messages,
// - orbits.sp3, clocks.clk and antennas.atx, in `gnss` only,
// - truth.csv: index, GPS seconds of the week, and X, Y, Z of the antenna's reference point.
// Throws std::runtime_error naming a file that cannot be written.
void write_gnss(const std::filesystem::path& folder, const GnssSetting& setting);

}  // namespace maploop::simulate
