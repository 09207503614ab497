// Simulates small objects around the antenna (roof, ground, cars, railings) that reflect a
// satellite's signal weakly; they make code measurements wrong even under an open sky.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/simulate/gnss/signal_paths.h"
#include "tools/simulate/random.h"

namespace maploop::simulate {

// The scatterers of one satellite. Each stays for some tens of seconds and metres driven, then
// another replaces it; as the car moves, their paths become longer or shorter.
class Scatterers {
 public:
  Scatterers(std::uint64_t seed, std::uint64_t stream);

  // Advances by `interval` s at a speed in m/s, and appends the scatterers' paths to `paths`.
  void add_to(std::vector<SignalPath>& paths, double interval, double speed);

 private:
  struct Scatterer {
    SignalPath path;
    double share = 0.0;  // rate of the path's length as a share of the speed
  };
  Scatterer draw();

  Random random_;
  std::array<Scatterer, 3> scatterers_;
};

}  // namespace maploop::simulate
