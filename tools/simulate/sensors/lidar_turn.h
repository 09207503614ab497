// Simulates the measurements of a spinning scanner during one turn.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

#include "sensors/replay/packed_scan.h"
#include "tools/simulate/scene/appearance.h"
#include "tools/simulate/scene/ray_scene.h"

namespace maploop::simulate {

enum class Scanner : std::uint8_t { hdl_64e, vlp_16 };
constexpr std::array<std::string_view, 2> names_of(Scanner) {
  return {"hdl-64e", "vlp-16"};
}

struct LidarParameters {
  Scanner scanner = Scanner::hdl_64e;
  std::size_t firings = 2083;           // in a turn, of all lasers together
  float reach = 120.0F;                 // m
  float noise = 0.015F;                 // m, 1 sigma along the beam
  float range_scale = 0.0F;             // 1, share by which ranges are too long
  float laser_offset = 0.02F;           // m, 1 sigma, constant range error of each laser
  float laser_angle = 0.0008F;          // rad, 1 sigma, constant direction error of each laser
  float elevation_error = 0.00357792F;  // rad (0.205 deg), by which all beams point higher
  float lost = 0.02F;      // share of beams that do not return even from a perfect target
  std::uint64_t unit = 1;  // seeds the offsets and directions of the lasers
};

// The defaults above are those of an HDL-64E. A VLP-16 fires 1800 times in a turn, and its
// elevations have no common error.
LidarParameters lidar_parameters(Scanner scanner);

// `T_enu_velo` gives the pose at a share of the turn, 0 to 1: from the rear over the left, the
// front and the right back to the rear, as the scanner spins clockwise. Ranges are in the scanner's
// own frame at the time of their own firing, as it measures them.
sensors::RangeImage take_turn(const RayScene& scene, const Appearance& appearance,
                              const std::function<Eigen::Isometry3d(double)>& T_enu_velo,
                              std::uint64_t seed, const LidarParameters& parameters = {});

}  // namespace maploop::simulate
