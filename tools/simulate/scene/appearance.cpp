#include "tools/simulate/scene/appearance.h"

#include <algorithm>
#include <cmath>

#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

constexpr std::uint32_t tile_side = 256;

std::uint32_t wrapped(std::int32_t i) {
  return static_cast<std::uint32_t>(i) % tile_side;
}

// Returns the share of a pixel of `footprint` metres at `distance` that is covered by a stripe of
// half width `half`.
float stripe(float distance, float half, float footprint) {
  const float pixels = 1.0F / std::max(footprint, 1e-4F);  // pixels in a metre
  return std::clamp((half - std::fabs(distance)) * pixels + 0.5F, 0.0F, 1.0F) *
         std::min(1.0F, 2.0F * half * pixels);
}

float fraction(float x) {
  return x - std::floor(x);
}

float blend(float a, float b, float share) {
  return a + share * (b - a);
}

// Returns a random number in [0, 1) for a cell.
float random_of(int i, int j, std::uint32_t seed) {
  const auto bits = mix(static_cast<std::uint64_t>(static_cast<std::uint32_t>(i)) << 32U |
                            static_cast<std::uint32_t>(j),
                        seed);
  return static_cast<float>(unit(bits));
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

float Appearance::albedo(const Surface& s, const Eigen::Vector2f& uv, const Eigen::Vector3f& place,
                         float footprint) const {
  const float u = uv.x(), v = uv.y();
  const auto noise = [&](float coarsest, int octaves, float gain) {
    return noise_(u, v, s.seed, coarsest, octaves, gain, footprint);
  };
  switch (s.material) {
    case Material::ground:
      return ground(s, place.head<2>().cast<double>(), footprint);
    case Material::plaster:
    case Material::brick:
      return facade(s, uv, footprint);
    case Material::roof: {
      const float rows = stripe(fraction(v / 0.35F) - 0.5F, 0.1F, footprint / 0.35F);
      return s.tone * (1.0F - 0.35F * rows + 0.2F * noise(1.5F, 3, 0.8F));
    }
    case Material::hedge:
      return s.tone * (1.0F + 0.7F * noise(0.5F, 3, 0.9F));
    case Material::forest:
      return s.tone * (1.0F + 0.5F * noise(12.0F, 4, 0.8F));
    case Material::fence: {
      const float gap = stripe(fraction(u / 0.14F) - 0.5F, 0.12F, footprint / 0.14F);
      const float board = random_of(static_cast<int>(u / 0.14F), 0, s.seed);
      return s.tone * (0.8F + 0.4F * board - 0.6F * gap + 0.2F * noise(0.8F, 3, 0.8F));
    }
    case Material::bark:
      return s.tone * (1.0F + 0.5F * noise(0.2F, 2, 0.8F));
    case Material::leaf:
      return s.tone * (1.0F + 0.4F * noise(0.3F, 2, 0.9F));
    case Material::sign:
      return blend(s.tone, 0.15F, stripe(fraction(v / 0.3F) - 0.5F, 0.2F, footprint / 0.3F));
    case Material::metal:
    case Material::paint:
    case Material::glass:
    case Material::tyre:
      break;
  }
  return s.tone * (1.0F + 0.08F * noise(0.6F, 2, 0.7F));
}

float Appearance::facade(const Surface& s, const Eigen::Vector2f& uv, float footprint) const {
  constexpr float storey = 3.0F, cellar = 3.0F;
  const float bay = 2.2F + 0.2F * static_cast<float>(s.seed % 8);
  const float u = uv.x(), v = uv.y() - cellar;
  float tone = s.tone * (1.0F + 0.14F * noise_(u, v, s.seed, 4.0F, 5, 0.75F, footprint));
  if (s.material == Material::brick) {
    const float row = v / 0.09F, shift = 0.5F * static_cast<float>(static_cast<int>(row) & 1);
    const float joint =
        std::max(stripe(fraction(row) - 0.5F, 0.08F, footprint / 0.09F),
                 stripe(fraction(u / 0.25F + shift) - 0.5F, 0.03F, footprint / 0.25F));
    tone = blend(tone, 0.5F, 0.6F * joint);
  }
  if (v < 0.6F) return 0.6F * tone;  // the base of the wall
  const int column = static_cast<int>(std::floor(u / bay));
  const int floor = static_cast<int>(std::floor(v / storey));
  const float x = fraction(u / bay) * bay - 0.5F * bay;
  const float y = fraction(v / storey) * storey - 1.6F;
  const float odd = random_of(column, floor, s.seed);
  if (odd < 0.12F) return tone;  // no window here
  const float half = 0.45F + 0.05F * static_cast<float>(s.seed / 8 % 5);
  const float frame = stripe(x, half + 0.12F, footprint) * stripe(y, 0.87F, footprint);
  const float pane = stripe(x, half, footprint) * stripe(y, 0.75F, footprint);
  const float bar = std::max(stripe(x, 0.035F, footprint), stripe(y - 0.3F, 0.03F, footprint));
  const float curtain = odd > 0.7F && y > -0.1F ? 0.45F : 0.0F;
  const float glass = 0.05F + 0.12F * random_of(floor, column, s.seed) + curtain;
  const float light = s.tone > 0.5F ? 0.3F : 0.75F;
  return blend(blend(tone, light, frame), blend(glass, light, bar), pane);
}

float Appearance::ground(const Surface& s, const Eigen::Vector2d& place, float footprint) const {
  const auto near = streets_->nearest(place);
  const float edge = static_cast<float>(near.first.edge);
  const float u = static_cast<float>(place.x()), v = static_cast<float>(place.y());
  constexpr float pavement = 2.0F;  // m wide
  if (near.first.street && edge < 0.0F) {
    // Patches of different age, and a fine grain.
    const float patch = noise_(u, v, 77, 9.0F, 2, 0.8F, footprint);
    const float grain = noise_(u, v, 5, 0.5F, 4, 0.9F, footprint);
    return road(near.first, near.second, s.tone * (1.0F + 0.16F * patch + 0.12F * grain),
                footprint);
  }
  if (near.first.street && edge < 0.18F)
    return 0.42F + 0.06F * noise_(u, v, 9, 0.7F, 3, 0.8F, footprint);
  if (near.first.street && edge < pavement) {
    const float along = static_cast<float>(near.first.along);
    const float joint = std::max(stripe(fraction(along / 0.5F) - 0.5F, 0.02F, footprint / 0.5F),
                                 stripe(fraction(edge / 0.45F) - 0.5F, 0.02F, footprint / 0.45F));
    const float slab = random_of(static_cast<int>(along / 0.5F), static_cast<int>(edge / 0.45F), 3);
    const float fade = std::clamp(0.45F / std::max(footprint, 1e-3F) - 1.0F, 0.0F, 1.0F);
    const float tone =
        0.33F + 0.07F * fade * (slab - 0.5F) + 0.04F * noise_(u, v, 4, 1.2F, 4, 0.8F, footprint);
    return tone * (1.0F - 0.5F * joint);
  }
  return 0.17F * (1.0F + 0.5F * noise_(u, v, 6, 2.5F, 5, 0.85F, footprint));
}

float Appearance::road(const StreetPlace& at, const StreetPlace& other, float tone,
                       float footprint) const {
  if (other.street && other.edge < 1.0) return tone;  // a junction has no markings
  constexpr float white = 0.72F;
  constexpr double before_junction = 10.0;  // m, where the markings end
  const double from_end = std::min(at.along, at.street->length() - at.along);
  const float left = static_cast<float>(at.left), along = static_cast<float>(at.along);
  const float half = static_cast<float>(at.street->half_width);
  if (from_end < before_junction) {
    // The stop line crosses the lane that leads to the junction.
    const bool to_begin = at.along < from_end + 1e-9;
    const bool approaching = to_begin ? left > 0.1F : left < -0.1F;
    if (!approaching) return tone;
    return blend(tone, white, stripe(static_cast<float>(from_end - 9.0), 0.25F, footprint));
  }
  float line = stripe(left, 0.06F, footprint);
  if (half < 4.0F) line *= stripe(fraction(along / 6.0F) - 0.5F, 0.25F, footprint / 6.0F);
  if (half >= 4.0F) line = std::max(line, stripe(std::fabs(left) - half + 0.35F, 0.06F, footprint));
  tone = blend(tone, white, line);
  // Manhole covers.
  const float cell = std::floor(along / 23.0F);
  const float cx = 23.0F * (cell + 0.5F),
              cy = cell == 2.0F * std::floor(cell / 2.0F) ? 1.1F : -1.4F;
  const float cover = stripe(std::hypot(along - cx, left - cy), 0.33F, footprint);
  return blend(tone, 0.12F, cover);
}

float Appearance::sky(const Eigen::Vector3f& d) const {
  const float up = std::max(0.03F, d.z());
  const float clouds = noise_(2.0F * d.x() / up, 2.0F * d.y() / up, 11, 3.0F, 3, 0.5F, 0.1F / up);
  return 0.85F + 0.12F * clouds;
}

}  // namespace maploop::simulate
