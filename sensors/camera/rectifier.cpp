#include "sensors/camera/rectifier.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace maploop::sensors {
namespace {

constexpr int unit_weight = 256;  // weight 1, in steps of 1/256 px

// Holds the raw pixel above and left of the place that a rectified pixel looks at, and how far the
// place lies to the right of it and below it.
struct Place {
  std::int32_t first = -1;  // negative if the place is outside of the raw image
  std::uint16_t right = 0, down = 0;
};

using Map = std::vector<Place>;

Place place_of(const Eigen::Vector2d& pixel, int width, int height) {
  if (!(pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= width - 1 && pixel.y() <= height - 1))
    return {};
  // On the last row and column the previous one is `first`, and its neighbour gets the full weight.
  const int x = std::min(static_cast<int>(pixel.x()), width - 2);
  const int y = std::min(static_cast<int>(pixel.y()), height - 2);
  return {y * width + x, static_cast<std::uint16_t>(std::lround((pixel.x() - x) * unit_weight)),
          static_cast<std::uint16_t>(std::lround((pixel.y() - y) * unit_weight))};
}

Map make_map(const CameraModel& camera, const Eigen::Matrix3d& R_rect, const StereoRig& rig) {
  const StereoCalibration& r = rig.rectified;
  const Eigen::Matrix3d R_raw_rect = R_rect.transpose();
  Map map;
  map.reserve(static_cast<std::size_t>(r.width) * static_cast<std::size_t>(r.height));
  for (int v = 0; v < r.height; ++v) {
    for (int u = 0; u < r.width; ++u) {
      const Eigen::Vector3d ray =
          R_raw_rect * Eigen::Vector3d((u - r.cx) / r.fx, (v - r.cy) / r.fy, 1.0);
      std::optional<Eigen::Vector2d> pixel;
      if (ray.z() > 0.0) pixel = project(camera, ray.hnormalized());
      map.push_back(pixel ? place_of(*pixel, rig.width, rig.height) : Place{});
    }
  }
  return map;
}

void look_up(const GreyImage& raw, const Map& map, GreyImage& rectified) {
  const std::uint8_t* pixels = raw.pixels.data();
  std::uint8_t* out = rectified.pixels.data();
  for (const Place& place : map) {
    int value = 0;
    if (place.first >= 0) {
      const std::uint8_t* up = pixels + place.first;
      const std::uint8_t* low = up + raw.width;
      const int upper = up[0] * (unit_weight - place.right) + up[1] * place.right;
      const int lower = low[0] * (unit_weight - place.right) + low[1] * place.right;
      value = (upper * (unit_weight - place.down) + lower * place.down +
               unit_weight * unit_weight / 2) /
              (unit_weight * unit_weight);
    }
    *out++ = static_cast<std::uint8_t>(value);
  }
}

}  // namespace

struct Rectifier::Maps {
  int width, height;  // of raw images
  int rectified_width, rectified_height;
  Map left, right;
};

Rectifier::Rectifier(const StereoRig& rig) {
  if (const auto problem = problem_of(rig))
    throw std::invalid_argument("the images cannot be rectified: " + *problem);
  maps_ = std::make_unique<Maps>(
      Maps{rig.width, rig.height, rig.rectified.width, rig.rectified.height,
           make_map(rig.left, rig.R_rect_left, rig), make_map(rig.right, rig.R_rect_right, rig)});
}

Rectifier::~Rectifier() = default;
Rectifier::Rectifier(Rectifier&&) noexcept = default;
Rectifier& Rectifier::operator=(Rectifier&&) noexcept = default;

void Rectifier::rectify(const StereoPair& raw, StereoPair& rectified) const {
  for (const GreyImage* image : {&raw.left, &raw.right}) {
    if (image->width != maps_->width || image->height != maps_->height) {
      throw std::invalid_argument("a raw image is " + std::to_string(image->width) + " x " +
                                  std::to_string(image->height) +
                                  " pixels, the calibration's are " + std::to_string(maps_->width) +
                                  " x " + std::to_string(maps_->height));
    }
  }
  static_cast<Sample&>(rectified) = raw;
  rectified.left.resize(maps_->rectified_width, maps_->rectified_height);
  rectified.right.resize(maps_->rectified_width, maps_->rectified_height);
  look_up(raw.left, maps_->left, rectified.left);
  look_up(raw.right, maps_->right, rectified.right);
}

std::unique_ptr<Source<StereoPair>> make_rectified_source(std::unique_ptr<Source<StereoPair>> raw,
                                                          const StereoRig& rig, Time passed) {
  return derived(std::move(raw), [rectifier = Rectifier(rig), passed, read = StereoPair()](
                                     Source<StereoPair>& source, StereoPair& pair) mutable {
    if (!source.next(read)) return false;
    if (read.available > passed) {
      rectifier.rectify(read, pair);
    } else {
      static_cast<Sample&>(pair) = read;
    }
    return true;
  });
}

}  // namespace maploop::sensors
