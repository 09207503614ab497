// Computes how bright surfaces are: procedural textures are evaluated where a ray hits.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "tools/simulate/scene/mesh.h"
#include "tools/simulate/town/streets.h"

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

class Appearance {
 public:
  explicit Appearance(const StreetIndex& streets) : streets_(&streets) {}

  // Returns the albedo, 0 to 1, of a pixel that covers `footprint` metres; `uv` (m) is on the
  // surface, `place` (m) is in enu.
  float albedo(const Surface& surface, const Eigen::Vector2f& uv, const Eigen::Vector3f& place,
               float footprint) const;
  // Returns the brightness of the sky in a unit direction, enu.
  float sky(const Eigen::Vector3f& direction) const;

 private:
  float facade(const Surface& surface, const Eigen::Vector2f& uv, float footprint) const;
  float ground(const Surface& surface, const Eigen::Vector2d& place, float footprint) const;
  float road(const StreetPlace& at, const StreetPlace& other, float tone, float footprint) const;

  const StreetIndex* streets_;
  NoiseTexture noise_;
};

}  // namespace maploop::simulate
