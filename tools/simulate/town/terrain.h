// Simulates the height of the ground.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "tools/simulate/random.h"

namespace maploop::simulate {

// The sum of long gentle waves, with grades of a few percent. Metres, enu.
class Terrain {
 public:
  explicit Terrain(std::uint64_t seed) {
    Random random(seed, 1);
    for (Wave& wave : waves_) {
      const double length = random.uniform(180.0, 420.0);
      const double direction = random.uniform(0.0, 2.0 * std::numbers::pi);
      const double number = 2.0 * std::numbers::pi / length;
      wave.number = number * Eigen::Vector2d(std::cos(direction), std::sin(direction));
      wave.amplitude = random.uniform(0.4, 1.0);
      wave.phase = random.uniform(0.0, 2.0 * std::numbers::pi);
    }
  }

  double height(const Eigen::Vector2d& p) const {
    double z = 0.0;
    for (const Wave& wave : waves_) z += wave.amplitude * std::sin(wave.number.dot(p) + wave.phase);
    return z;
  }

  Eigen::Vector2d gradient(const Eigen::Vector2d& p) const {
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    for (const Wave& wave : waves_)
      g += wave.amplitude * std::cos(wave.number.dot(p) + wave.phase) * wave.number;
    return g;
  }

 private:
  struct Wave {
    Eigen::Vector2d number;  // rad/m
    double amplitude;        // m
    double phase;            // rad
  };
  std::array<Wave, 4> waves_;
};

}  // namespace maploop::simulate
