// Simulates the height of the ground.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace maploop::simulate {

// The sum of long gentle waves, with grades of a few percent. Metres, enu.
class Terrain {
 public:
  explicit Terrain(std::uint64_t seed);

  double height(const Eigen::Vector2d& p) const;
  Eigen::Vector2d gradient(const Eigen::Vector2d& p) const;

 private:
  struct Wave {
    Eigen::Vector2d number;  // rad/m
    double amplitude;        // m
    double phase;            // rad
  };
  std::array<Wave, 4> waves_;
};

}  // namespace maploop::simulate
