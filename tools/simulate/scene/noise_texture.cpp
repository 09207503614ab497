#include "tools/simulate/scene/noise_texture.h"

#include <algorithm>
#include <cmath>

#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr std::uint32_t tile_side = 256;

std::uint32_t wrapped(std::int32_t i) {
  return static_cast<std::uint32_t>(i) % tile_side;
}

}  // namespace

NoiseTexture::NoiseTexture() : tile_(tile_side * tile_side) {
  Random random(1, 8);  // the tile is the same in every world; the seed of a surface shifts it
  for (float& value : tile_) value = static_cast<float>(random.uniform(-1.0, 1.0));
}

float NoiseTexture::lattice(float x, float y) const {
  const auto i = static_cast<std::int32_t>(std::floor(x));
  const auto j = static_cast<std::int32_t>(std::floor(y));
  const std::uint32_t x0 = wrapped(i), x1 = wrapped(i + 1);
  const std::uint32_t y0 = wrapped(j) * tile_side, y1 = wrapped(j + 1) * tile_side;
  const float s = x - static_cast<float>(i), t = y - static_cast<float>(j);
  const float a = tile_[y0 + x0] + s * (tile_[y0 + x1] - tile_[y0 + x0]);
  const float b = tile_[y1 + x0] + s * (tile_[y1 + x1] - tile_[y1 + x0]);
  return a + t * (b - a);
}

float NoiseTexture::operator()(float u, float v, std::uint32_t seed, float coarsest, int octaves,
                               float gain, float footprint) const {
  const float du = static_cast<float>(seed & 0xffU), dv = static_cast<float>(seed >> 8U & 0xffU);
  constexpr float finer = 3.0F;  // ratio of the wavelengths of consecutive octaves
  float sum = 0.0F, weight = 1.0F;
  float pixels = coarsest / std::max(footprint, 1e-6F), waves = 1.0F / coarsest;
  for (int i = 0; i < octaves && pixels > 1.0F; ++i) {
    const float seen = std::min(1.0F, pixels - 1.0F);
    sum += weight * seen * lattice(u * waves + du, v * waves + dv);
    weight *= gain;
    pixels *= 1.0F / finer;
    waves *= finer;
  }
  return sum;
}

}  // namespace maploop::simulate
