#include "tools/simulate/noise_texture.h"

#include <algorithm>
#include <cmath>

#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr std::uint32_t tile_side = 256;

}  // namespace

NoiseTexture::NoiseTexture() : tile_(tile_side * tile_side) {
  Random random(1, 8);  // the same in every world: seeds move it
  for (float& value : tile_) value = static_cast<float>(random.uniform(-1.0, 1.0));
}

float NoiseTexture::lattice(float x, float y) const {
  const float fx = std::floor(x), fy = std::floor(y);
  const auto i = static_cast<std::uint32_t>(static_cast<std::int32_t>(fx));
  const auto j = static_cast<std::uint32_t>(static_cast<std::int32_t>(fy));
  const std::uint32_t x0 = i % tile_side, x1 = (i + 1) % tile_side;
  const std::uint32_t y0 = j % tile_side * tile_side, y1 = (j + 1) % tile_side * tile_side;
  const float s = x - fx, t = y - fy;
  const float a = tile_[y0 + x0] + s * (tile_[y0 + x1] - tile_[y0 + x0]);
  const float b = tile_[y1 + x0] + s * (tile_[y1 + x1] - tile_[y1 + x0]);
  return a + t * (b - a);
}

float NoiseTexture::operator()(float u, float v, std::uint32_t seed, float coarsest, int octaves,
                               float gain, float footprint) const {
  const float du = static_cast<float>(seed & 0xffU), dv = static_cast<float>(seed >> 8U & 0xffU);
  float sum = 0.0F, weight = 1.0F;
  for (int i = 0; i < octaves; ++i) {
    const float seen = std::min(1.0F, coarsest / std::max(footprint, 1e-6F) - 1.0F);
    if (seen <= 0.0F) break;
    sum += weight * seen * lattice(u / coarsest + du, v / coarsest + dv);
    weight *= gain;
    coarsest *= 0.33F;
  }
  return sum;
}

}  // namespace maploop::simulate
