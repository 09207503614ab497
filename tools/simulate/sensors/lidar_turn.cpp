#include "tools/simulate/sensors/lidar_turn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "msgs/frames.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr std::size_t most_lasers = 64;

std::size_t lasers_of(Scanner scanner) {
  return scanner == Scanner::hdl_64e ? 64 : 16;
}

// Returns the elevation in rad. HDL-64E: the upper block descends from +2 degrees in steps of 1/3,
// the lower from -8.83 in steps of 1/2. VLP-16: from +15 in steps of 2.
double elevation(Scanner scanner, std::size_t laser) {
  const auto i = static_cast<double>(laser);
  if (scanner == Scanner::vlp_16) return radians(15.0 - 2.0 * i);
  return radians(laser < 32 ? 2.0 - i / 3.0 : -8.83 - (i - 32.0) / 2.0);
}

Eigen::Vector3f beam(double azimuth, double up) {
  return Eigen::Vector3d(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth),
                         std::sin(up))
      .cast<float>();
}

// The constant errors of each laser.
struct LaserErrors {
  double azimuth, elevation;  // rad
  float range;                // m
};

// The errors are the same in every turn.
std::array<LaserErrors, most_lasers> scanner_errors(const LidarParameters& p) {
  Random random(p.unit, 11);
  std::array<LaserErrors, most_lasers> errors{};
  for (LaserErrors& e : errors) {
    e.azimuth = static_cast<double>(p.laser_angle) * random.normal();
    e.elevation = static_cast<double>(p.laser_angle) * random.normal() +
                  static_cast<double>(p.elevation_error);
    e.range = p.laser_offset * static_cast<float>(random.normal());
  }
  return errors;
}

}  // namespace

LidarParameters lidar_parameters(Scanner scanner) {
  LidarParameters p;
  p.scanner = scanner;
  if (scanner == Scanner::hdl_64e) return p;
  p.firings = 1800;
  p.reach = 100.0F;
  p.elevation_error = 0.0F;
  return p;
}

sensors::RangeImage take_turn(const RayScene& scene, const Appearance& appearance,
                              const std::function<Eigen::Isometry3d(double)>& T_enu_velo,
                              std::uint64_t seed, const LidarParameters& p) {
  using sensors::RangeImage;
  Random random(seed, 10);
  const auto scanner = scanner_errors(p);
  const std::size_t lasers = lasers_of(p.scanner);
  RangeImage image;
  for (std::size_t laser = 0; laser < lasers; ++laser)
    image.elevations.push_back(static_cast<float>(elevation(p.scanner, laser)));
  const double turn = 2.0 * std::numbers::pi;
  image.firings = p.firings;
  image.azimuth_step = -turn / static_cast<double>(p.firings);
  image.first_azimuth = std::numbers::pi + 0.5 * image.azimuth_step;
  image.ranges.assign(lasers * p.firings, 0);
  image.reflectances.assign(lasers * p.firings, 0);
  Rays rays;
  Hits hits;
  for (std::size_t firing = 0; firing < p.firings; ++firing) {
    const double share = (static_cast<double>(firing) + 0.5) / static_cast<double>(p.firings);
    const double azimuth = std::numbers::pi - turn * share;
    const Eigen::Isometry3f T = T_enu_velo(share).cast<float>();
    for (std::size_t first = 0; first < lasers; first += packet) {
      for (std::size_t i = 0; i < packet; ++i) {
        const LaserErrors& error = scanner[first + i];
        const double up = elevation(p.scanner, first + i) + error.elevation;
        rays[i] = {T.translation(), T.linear() * beam(azimuth + error.azimuth, up),
                   static_cast<float>(share)};
      }
      scene.cast(rays, p.reach, hits);
      for (std::size_t i = 0; i < packet; ++i) {
        const Hit& hit = hits[i];
        const float noise = p.noise * static_cast<float>(random.normal());
        const bool lost = random.chance(static_cast<double>(p.lost));
        const bool faint = random.chance(0.5);
        if (!hit.any || lost) continue;
        const Eigen::Vector3f place = T.translation() + hit.range * rays[i].direction;
        const float slant = std::max(0.0F, -hit.normal.dot(rays[i].direction));
        const float albedo = appearance.albedo(*hit.surface, hit.uv, place, 0.003F * hit.range);
        // The echo falls with the square of the range. Dark or slanted surfaces far away, and some
        // of the beams that hit a car's windows, do not return.
        const float echo = albedo * slant * 2500.0F / (hit.range * hit.range);
        const bool glass = hit.surface->material == Material::glass;
        if (echo < 0.004F || (echo < 0.012F && faint) || (glass && faint)) continue;
        const float range = hit.range * (1.0F + p.range_scale) + noise + scanner[first + i].range;
        const std::size_t at = (first + i) * p.firings + firing;
        image.ranges[at] = static_cast<std::uint16_t>(
            std::clamp(std::lround(range / RangeImage::range_unit), 0L, 65535L));
        image.reflectances[at] = static_cast<std::uint8_t>(
            std::lround(std::min(0.99F, albedo) / RangeImage::reflectance_unit));
      }
    }
  }
  return image;
}

}  // namespace maploop::simulate
