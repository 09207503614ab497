// How bright surfaces are: procedural textures, evaluated where a ray hits.
#pragma once

#include <Eigen/Core>

#include "tools/simulate/mesh.h"
#include "tools/simulate/noise_texture.h"
#include "tools/simulate/street_index.h"

namespace maploop::simulate {

class Appearance {
 public:
  explicit Appearance(const StreetIndex& streets) : streets_(&streets) {}

  // Albedo, 0 to 1, of a pixel of `footprint` metres; `uv` (m) on the surface, `place` in enu.
  float albedo(const Surface& surface, const Eigen::Vector2f& uv, const Eigen::Vector3f& place,
               float footprint) const;
  // Of the sky in a direction.
  float sky(const Eigen::Vector3f& direction) const;

 private:
  float facade(const Surface& surface, const Eigen::Vector2f& uv, float footprint) const;
  float ground(const Surface& surface, const Eigen::Vector2d& place, float footprint) const;
  float road(const StreetPlace& at, const StreetPlace& other, float tone, float footprint) const;

  const StreetIndex* streets_;
  NoiseTexture noise_;
};

}  // namespace maploop::simulate
