// Band-limited noise, for what surfaces look like.
#pragma once

#include <cstdint>
#include <vector>

namespace maploop::simulate {

// Octaves of value noise from one tile, 256 lattice points a side.
class NoiseTexture {
 public:
  NoiseTexture();

  // In about [-1, 1], zero mean: octaves from wavelength `coarsest` (m) down, each a third of the
  // one before and `gain` times as strong, as far as a pixel of `footprint` metres can show them.
  float operator()(float u, float v, std::uint32_t seed, float coarsest, int octaves, float gain,
                   float footprint) const;

 private:
  float lattice(float x, float y) const;

  std::vector<float> tile_;
};

}  // namespace maploop::simulate
