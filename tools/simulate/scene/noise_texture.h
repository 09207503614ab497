// Band-limited noise, the base of procedural textures.
#pragma once

#include <cstdint>
#include <vector>

namespace maploop::simulate {

// Sums octaves of value noise from one tile of 256 x 256 lattice points.
class NoiseTexture {
 public:
  NoiseTexture();

  // Returns noise in about [-1, 1] with zero mean. Its octaves start at wavelength `coarsest` (m);
  // each has a third of the previous wavelength and `gain` times its strength. Octaves that a pixel
  // of `footprint` metres cannot show are left out.
  float operator()(float u, float v, std::uint32_t seed, float coarsest, int octaves, float gain,
                   float footprint) const;

 private:
  float lattice(float x, float y) const;

  std::vector<float> tile_;
};

}  // namespace maploop::simulate
