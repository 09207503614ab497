#include "tools/simulate/gnss/scatterers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace maploop::simulate {

Scatterers::Scatterers(std::uint64_t seed, std::uint64_t stream) : random_(mix(seed, 29), stream) {
  for (Scatterer& s : scatterers_) s = draw();
}

Scatterers::Scatterer Scatterers::draw() {
  Scatterer s;
  s.path.amplitude = random_.uniform(0.04, 0.16);
  s.path.delay = std::exp(random_.uniform(std::log(0.3), std::log(30.0)));
  s.path.phase = random_.uniform(0.0, 2.0 * std::numbers::pi);
  s.path.surface = 1;
  s.share = random_.uniform(-0.6, 0.6);
  return s;
}

void Scatterers::add_to(std::vector<SignalPath>& paths, double interval, double speed) {
  constexpr double lasting = 60.0, lasting_way = 40.0;  // s and m, mean life of a scatterer
  constexpr double drift = 4e-4;                        // m/s, because the satellite moves
  const double gone = interval * (1.0 / lasting + speed / lasting_way);
  for (Scatterer& s : scatterers_) {
    if (random_.chance(std::min(1.0, gone))) s = draw();
    s.path.rate = s.share * speed + drift;
    s.path.delay = std::clamp(s.path.delay + s.path.rate * interval, 0.1, 60.0);
    if (paths.empty()) continue;
    SignalPath path = s.path;  // relative to the strongest path
    path.amplitude *= paths.front().amplitude;
    path.delay += paths.front().delay;
    path.rate += paths.front().rate;
    paths.push_back(path);
  }
}

}  // namespace maploop::simulate
