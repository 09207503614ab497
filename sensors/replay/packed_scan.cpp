#include "sensors/replay/packed_scan.h"

#include <zlib.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace maploop::sensors {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

constexpr std::string_view magic = "MLSCAN1\n";

struct Head {
  std::uint32_t lasers, firings;
  double first_azimuth, azimuth_step;
  std::uint32_t returns, reserved;
};
static_assert(sizeof(Head) == 32);

// Maps small numbers of either sign to small unsigned ones: 0, -1, 1, -2 ...
std::uint16_t folded(std::uint16_t difference) {
  return static_cast<std::uint16_t>((difference << 1U) ^ ((difference & 0x8000U) ? 0xffffU : 0U));
}
std::uint16_t unfolded(std::uint16_t value) {
  return static_cast<std::uint16_t>((value >> 1U) ^ ((value & 1U) ? 0xffffU : 0U));
}

// Lays out the uncompressed data: one bit for each laser and firing, set if it has a return, then
// for the returns the differences of ranges (low bytes, then high bytes) and of reflectances.
struct Planes {
  Planes(std::size_t all, std::size_t returns)
      : low((all + 7) / 8), high(low + returns), reflectance(high + returns) {}
  std::size_t size(std::size_t returns) const { return reflectance + returns; }
  std::size_t low, high, reflectance;  // offsets of the parts, bytes
};

}  // namespace

void points_of(const RangeImage& image, std::vector<LidarPoint>& points) {
  points.clear();
  std::vector<std::array<float, 2>> directions;
  for (std::size_t k = 0; k < image.firings; ++k) {
    const double azimuth = image.first_azimuth + image.azimuth_step * static_cast<double>(k);
    directions.push_back(
        {static_cast<float>(std::cos(azimuth)), static_cast<float>(std::sin(azimuth))});
  }
  for (std::size_t laser = 0; laser < image.elevations.size(); ++laser) {
    const float up = std::sin(image.elevations[laser]), level = std::cos(image.elevations[laser]);
    for (std::size_t k = 0; k < image.firings; ++k) {
      const std::size_t i = laser * image.firings + k;
      if (image.ranges[i] == 0) continue;
      const auto range = static_cast<float>(RangeImage::range_unit * image.ranges[i]);
      points.push_back({range * level * directions[k][0], range * level * directions[k][1],
                        range * up,
                        static_cast<float>(RangeImage::reflectance_unit * image.reflectances[i])});
    }
  }
}

std::string pack_scan(const RangeImage& image) {
  std::uint32_t returns = 0;
  for (const std::uint16_t range : image.ranges) returns += range != 0;
  const Planes planes(image.ranges.size(), returns);
  std::vector<Bytef> plain(planes.size(returns), 0);
  std::uint16_t range = 0;
  std::uint8_t reflectance = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < image.ranges.size(); ++i) {
    if (image.ranges[i] == 0) continue;
    plain[i / 8] = static_cast<Bytef>(plain[i / 8] | (1U << (i % 8)));
    const std::uint16_t step = folded(static_cast<std::uint16_t>(image.ranges[i] - range));
    plain[planes.low + at] = static_cast<Bytef>(step & 0xffU);
    plain[planes.high + at] = static_cast<Bytef>(step >> 8U);
    plain[planes.reflectance + at] = static_cast<Bytef>(image.reflectances[i] - reflectance);
    range = image.ranges[i];
    reflectance = image.reflectances[i];
    ++at;
  }
  const Head head{static_cast<std::uint32_t>(image.elevations.size()),
                  static_cast<std::uint32_t>(image.firings),
                  image.first_azimuth,
                  image.azimuth_step,
                  returns,
                  0};
  std::string text(magic);
  text.append(reinterpret_cast<const char*>(&head), sizeof head);
  text.append(reinterpret_cast<const char*>(image.elevations.data()),
              image.elevations.size() * sizeof(float));
  const std::size_t begin = text.size();
  uLongf size = compressBound(plain.size());
  text.resize(begin + size);
  if (compress2(reinterpret_cast<Bytef*>(text.data() + begin), &size, plain.data(), plain.size(),
                Z_DEFAULT_COMPRESSION) != Z_OK)
    throw std::runtime_error("the scan cannot be compressed");
  text.resize(begin + size);
  return text;
}

void unpack_scan(const std::vector<char>& bytes, RangeImage& image,
                 std::vector<LidarPoint>& points) {
  Head head;
  if (bytes.size() < magic.size() + sizeof head ||
      std::string_view(bytes.data(), magic.size()) != magic)
    throw std::runtime_error("not a packed scan, or incomplete");
  std::memcpy(&head, bytes.data() + magic.size(), sizeof head);
  const std::size_t all = std::size_t{head.lasers} * head.firings;
  const std::size_t begin = magic.size() + sizeof head + head.lasers * sizeof(float);
  if (head.lasers == 0 || head.lasers > RangeImage::max_lasers ||
      head.firings > RangeImage::max_firings || head.returns > all || begin > bytes.size() ||
      !std::isfinite(head.first_azimuth) || !std::isfinite(head.azimuth_step))
    throw std::runtime_error("the packed scan is damaged: copy it again from its source");
  image.elevations.resize(head.lasers);
  std::memcpy(image.elevations.data(), bytes.data() + magic.size() + sizeof head,
              head.lasers * sizeof(float));
  image.firings = head.firings;
  image.first_azimuth = head.first_azimuth;
  image.azimuth_step = head.azimuth_step;
  const Planes planes(all, head.returns);
  std::vector<Bytef> plain(planes.size(head.returns));
  uLongf size = plain.size();
  const int state =
      uncompress(plain.data(), &size, reinterpret_cast<const Bytef*>(bytes.data() + begin),
                 bytes.size() - begin);
  std::size_t counted = 0;
  for (std::size_t i = 0; i < planes.low; ++i)
    counted += static_cast<std::size_t>(std::popcount(plain[i]));
  if (state != Z_OK || size != plain.size() || counted != head.returns)
    throw std::runtime_error(
        "the packed scan is incomplete or damaged: copy it again from its source");
  image.ranges.assign(all, 0);
  image.reflectances.assign(all, 0);
  std::uint16_t range = 0;
  std::uint8_t reflectance = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < all && at < head.returns; ++i) {
    if ((plain[i / 8] >> (i % 8) & 1U) == 0) continue;
    const auto step =
        static_cast<std::uint16_t>(plain[planes.low + at] | (plain[planes.high + at] << 8U));
    range = static_cast<std::uint16_t>(range + unfolded(step));
    reflectance = static_cast<std::uint8_t>(reflectance + plain[planes.reflectance + at]);
    image.ranges[i] = range;
    image.reflectances[i] = reflectance;
    ++at;
  }
  points_of(image, points);
  if (points.empty()) throw std::runtime_error("the packed scan has no points");
}

}  // namespace maploop::sensors
