#include "tools/simulate/town/height_tile.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "msgs/frames.h"
#include "ppp/heights/height_model.h"
#include "tools/simulate/output_file.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr int side = 1201;               // samples
constexpr long no_height = -32768;       // of a void sample
constexpr double surroundings = 3000.0;  // m of ground around what is built up; the rest is void

// An error that is the same everywhere, and two that change over the ground: sums of waves in
// random directions.
class RadarError {
 public:
  explicit RadarError(std::uint64_t seed) : random_(seed, 40), offset_(1.6 * random_.normal()) {
    fill(far_, 1.5, 5000.0);
    fill(near_, 2.0, 200.0);
  }

  double at(const Eigen::Vector2d& p) const {
    double error = offset_;
    for (const auto* waves : {&far_, &near_}) {
      for (const Wave& wave : *waves) {
        error += wave.amplitude * std::sin(wave.number.dot(p) + wave.phase);
      }
    }
    return error;
  }

 private:
  struct Wave {
    Eigen::Vector2d number;  // rad/m
    double amplitude, phase;
  };
  using Waves = std::array<Wave, 24>;

  // Waves of all lengths around 2 pi times the correlation length.
  void fill(Waves& waves, double sigma, double length) {
    for (Wave& wave : waves) {
      const double number = random_.uniform(0.3, 2.0) / length;
      const double direction = random_.uniform(0.0, 2.0 * std::numbers::pi);
      wave.number = number * Eigen::Vector2d(std::cos(direction), std::sin(direction));
      wave.amplitude = sigma * std::sqrt(2.0 / static_cast<double>(waves.size()));
      wave.phase = random_.uniform(0.0, 2.0 * std::numbers::pi);
    }
  }

  Random random_;
  double offset_;  // m
  Waves far_{}, near_{};
};

// The mean height of what is seen from above in the square around a place, m, enu.
double seen_from_above(const RayScene& scene, const Eigen::Vector2d& middle) {
  constexpr double half = 45.0, sky = 200.0;  // m
  constexpr int rays = 16;                    // along each side
  double sum = 0.0;
  int count = 0;
  for (int row = 0; row < rays; ++row) {
    for (int begin = 0; begin < rays; begin += static_cast<int>(packet)) {
      Rays few;
      Hits hits;
      for (std::size_t i = 0; i < packet; ++i) {
        const double column = begin + static_cast<int>(i);
        const Eigen::Vector2d p = middle + half * Eigen::Vector2d(2.0 * (column + 0.5) / rays - 1.0,
                                                                  2.0 * (row + 0.5) / rays - 1.0);
        few[i] = {Eigen::Vector3d(p.x(), p.y(), sky).cast<float>(), {0.0F, 0.0F, -1.0F}, 0.0F};
      }
      scene.cast(few, 2.0F * static_cast<float>(sky), hits);
      for (const Hit& hit : hits) {
        if (!hit.any) continue;
        sum += sky - static_cast<double>(hit.range);
        ++count;
      }
    }
  }
  return count > 0 ? sum / count : 0.0;
}

void append_big_endian(std::string& bytes, long height) {
  const auto value = static_cast<std::uint16_t>(height);
  bytes += static_cast<char>(value >> 8U);
  bytes += static_cast<char>(value & 0xffU);
}

}  // namespace

void write_height_tile(const std::filesystem::path& folder, const GroundSetting& setting) {
  const RadarError error(setting.seed);
  const RayScene scene(setting.world);
  const ppp::GeoidGrid geoid = ppp::read_geoid_grid(ppp::HeightModel::usual_geoid);
  const Geodetic& origin = setting.frame.origin();
  const int south = static_cast<int>(std::floor(degrees(origin.latitude)));
  const int west = static_cast<int>(std::floor(degrees(origin.longitude)));
  const auto within = [&](const Eigen::Vector2d& p, double margin) {
    return (p.array() > setting.least.array() - margin).all() &&
           (p.array() < setting.most.array() + margin).all();
  };
  std::string bytes;
  bytes.reserve(2 * side * side);
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const double latitude = south + 1.0 - row / (side - 1.0);
      const double longitude = west + column / (side - 1.0);
      const Eigen::Vector2d p =
          setting.frame.to_enu({radians(latitude), radians(longitude), origin.height}).head<2>();
      if (!within(p, surroundings)) {
        append_big_endian(bytes, no_height);
        continue;
      }
      const double up = within(p, 0.0) ? seen_from_above(scene, p) : setting.terrain.height(p);
      append_big_endian(bytes, std::lround(origin.height - geoid.at(latitude, longitude).value() +
                                           up + error.at(p)));
    }
  }
  std::filesystem::create_directories(folder);
  write_file(folder / fmt::format("{}{:02}{}{:03}.hgt", south < 0 ? 'S' : 'N', std::abs(south),
                                  west < 0 ? 'W' : 'E', std::abs(west)),
             bytes);
}

}  // namespace maploop::simulate
