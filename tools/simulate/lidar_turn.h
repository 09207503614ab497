// What a spinning scanner on the vehicle measures in a turn.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "sensors/replay/packed_scan.h"
#include "tools/simulate/appearance.h"
#include "tools/simulate/ray_scene.h"

namespace maploop::simulate {

enum class Scanner {
  hdl_64e,
  vlp_16,
};

struct LidarParameters {
  Scanner scanner = Scanner::hdl_64e;
  std::size_t firings = 2083;           // a turn, of all lasers
  float reach = 120.0F;                 // m
  float noise = 0.015F;                 // m, 1 sigma along the beam
  float range_scale = 0.0F;             // 1, by how much ranges are too long
  float laser_offset = 0.02F;           // m, 1 sigma, what each laser measures wrong all the time
  float laser_angle = 0.0008F;          // rad, 1 sigma, what each points beside its known direction
  float elevation_error = 0.00357792F;  // rad (0.205 deg), how much higher all beams really point
  float lost = 0.02F;                   // share of beams that do not return, at a perfect target
  std::uint64_t unit = 1;               // another one, other offsets and directions of its lasers
};

// An HDL-64E's are above; a VLP-16 fires 1800 times a turn, and its beams are where they should be.
LidarParameters lidar_parameters(Scanner scanner);

// `T_enu_velo` gives the pose at a share of the turn, 0 to 1: from the rear over the left, the
// front and the right to the rear, as the scanner spins clockwise. Ranges are
// of the scanner's own frame at their own firing, as it measures them.
sensors::RangeImage take_turn(const RayScene& scene, const Appearance& appearance,
                              const std::function<Eigen::Isometry3d(double)>& T_enu_velo,
                              std::uint64_t seed, const LidarParameters& parameters = {});

}  // namespace maploop::simulate
