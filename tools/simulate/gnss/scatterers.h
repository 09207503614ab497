// Small things around the antenna (roof, ground, cars, railings) that reflect a satellite's signal
// weakly: what leaves codes wrong under an open sky.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/simulate/gnss/signal_paths.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {

// Those of one satellite. Each stays for some tens of seconds and metres of way, then another takes
// its place; as the car moves, their ways become longer or shorter.
class Scatterers {
 public:
  Scatterers(std::uint64_t seed, std::uint64_t stream);

  // `interval` s later, at a speed in m/s. Their paths join those that are there.
  void add_to(std::vector<SignalPath>& paths, double interval, double speed);

 private:
  struct Scatterer {
    SignalPath path;
    double share = 0.0;  // of the speed, by which its way changes
  };
  Scatterer draw();

  Random random_;
  std::array<Scatterer, 3> scatterers_;
};

}  // namespace maploop::simulate
