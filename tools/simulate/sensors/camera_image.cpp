#include "tools/simulate/sensors/camera_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

using Eigen::Vector3f;

float unit_float(std::uint64_t bits) {
  return static_cast<float>(unit(bits));
}

// Returns an approximately standard normal number from 64 random bits: the scaled sum of their
// bytes.
float grey_noise(std::uint64_t bits) {
  std::uint64_t sum = (bits & 0x00ff00ff00ff00ffU) + (bits >> 8U & 0x00ff00ff00ff00ffU);
  sum = (sum & 0xffffU) + (sum >> 16U & 0xffffU) + (sum >> 32U & 0xffffU) + (sum >> 48U);
  return (static_cast<float>(sum) - 8.0F * 127.5F) / (73.9F * 2.828427F);
}

const Vector3f to_sun = Vector3f(0.4F, -0.45F, 0.8F).normalized();

// Paint and glass reflect part of the sky.
float gloss(const Hit& hit, const Vector3f& direction) {
  const Material material = hit.surface->material;
  if (material != Material::paint && material != Material::glass) return 0.0F;
  const float up = direction.z() - 2.0F * hit.normal.dot(direction) * hit.normal.z();
  return material == Material::glass ? 0.04F + 0.2F * std::max(0.0F, up)
                                     : 0.02F + 0.1F * std::max(0.0F, up);
}

// Computes the light that falls on the pixels of an image.
class Sampling {
 public:
  Sampling(const RayScene& scene, const Appearance& appearance, const StereoCalibration& camera,
           const CameraView& view, float time, const CameraParameters& parameters)
      : scene_(scene),
        appearance_(appearance),
        camera_(camera),
        begin_(view.T_enu_cam[0].translation().cast<float>()),
        way_((view.T_enu_cam[1].translation() - view.T_enu_cam[0].translation()).cast<float>()),
        R_(view.T_enu_cam[0].linear().cast<float>()),
        turn_((view.T_enu_cam[1].linear() - view.T_enu_cam[0].linear()).cast<float>()),
        time_(time),
        p_(parameters),
        fx_(static_cast<float>(camera.fx)),
        fy_(static_cast<float>(camera.fy)) {
    shift_.resize(static_cast<std::size_t>(camera.width) + packet);
    for (std::size_t x = 0; x < shift_.size(); ++x)
      shift_[x] = view.shift.at(static_cast<float>(x), static_cast<float>(camera.width));
  }

  // Returns the light of each pixel; a white surface in the sun has 1.
  cv::Mat light(std::uint64_t seed) {
    cv::Mat light(camera_.height, camera_.width, CV_32F);
    const std::uint64_t first = mix(seed, 0), second = mix(seed, 1);
    for (int y = 0; y < camera_.height; y += rows)
      for (int x = 0; x < camera_.width; x += columns) {
        std::array<float, packet> seen = look(x, y, first);
        if (!alike(seen)) {
          const std::array<float, packet> again = look(x, y, second);
          for (std::size_t i = 0; i < packet; ++i) seen[i] = 0.5F * (seen[i] + again[i]);
        }
        for (std::size_t i = 0; i < packet; ++i) {
          const int column = x + column_of(i), row = y + row_of(i);
          if (column < camera_.width && row < camera_.height)
            light.at<float>(row, column) = seen[i];
        }
      }
    return light;
  }

 private:
  // The pixels of a packet are neighbours, so that its rays mostly hit the same surfaces.
  static constexpr int columns = 4, rows = static_cast<int>(packet) / columns;
  static int column_of(std::size_t i) { return static_cast<int>(i) % columns; }
  static int row_of(std::size_t i) { return static_cast<int>(i) / columns; }

  // Draws a ray through a random place of each pixel of a packet, at a random moment of the
  // exposure.
  void aim(int x0, int y0, std::uint64_t seed) {
    for (std::size_t i = 0; i < packet; ++i) {
      const int x = x0 + column_of(i), y = y0 + row_of(i);
      const std::uint64_t bits = mix(seed, static_cast<std::uint64_t>(y * 4096 + x));
      const float u = static_cast<float>(x) + unit_float(bits) - 0.5F +
                      shift_[static_cast<std::size_t>(x)] - static_cast<float>(camera_.cx);
      const float v =
          static_cast<float>(y) + unit_float(bits << 24U) - 0.5F - static_cast<float>(camera_.cy);
      const float moment = unit_float(bits << 48U);
      rays_[i] = {begin_ + moment * way_,
                  (R_ + moment * turn_) * Vector3f(u / fx_, v / fy_, 1.0F).normalized(), time_};
    }
  }

  std::array<float, packet> look(int x0, int y0, std::uint64_t seed) {
    aim(x0, y0, seed);
    scene_.cast(rays_, p_.reach, hits_);
    find_shadows();
    std::array<float, packet> light;
    for (std::size_t i = 0; i < packet; ++i) light[i] = seen(i);
    return light;
  }

  // Whether all rays hit the same surface with nearly the same brightness, and that surface hardly
  // moves in the image during the exposure.
  bool alike(const std::array<float, packet>& seen) const {
    constexpr float edge = 0.05F;  // relative to a white surface in the sun
    const auto [darkest, brightest] = std::minmax_element(seen.begin(), seen.end());
    if (*brightest - *darkest > edge) return false;
    const Hit& first = hits_[0];
    for (std::size_t i = 1; i < packet; ++i) {
      const Hit& hit = hits_[i];
      if (hit.any != first.any) return false;
      if (hit.any && (hit.surface != first.surface || hit.normal != first.normal)) return false;
    }
    constexpr float most = 0.5F;  // px
    const Vector3f& d = rays_[0].direction;
    Vector3f smear = turn_ * (R_.transpose() * d);
    if (first.any) smear -= (way_ - way_.dot(d) * d) / first.range;
    return fx_ * smear.norm() < most;
  }

  void find_shadows() {
    for (std::size_t i = 0; i < packet; ++i) {
      const Hit& hit = hits_[i];
      lit_[i] = hit.any && hit.normal.dot(to_sun) > 0.0F;
      if (!lit_[i]) continue;
      const Vector3f place = rays_[i].origin + hit.range * rays_[i].direction;
      sun_rays_[i] = {place + 0.01F * hit.normal, to_sun, time_};
    }
    scene_.occluded(sun_rays_, lit_, shadowed_);
  }

  float seen(std::size_t i) const {
    const Hit& hit = hits_[i];
    const Vector3f& d = rays_[i].direction;
    if (!hit.any) return 0.55F * appearance_.sky(d);
    const float slant = std::max(0.04F, -hit.normal.dot(d));
    const float footprint = hit.range / fx_ / std::sqrt(slant);
    const Vector3f place = rays_[i].origin + hit.range * d;
    const float albedo = appearance_.albedo(*hit.surface, hit.uv, place, footprint);
    // The sky lights surfaces that face up more than those that face down.
    const float sky = p_.ambient * (0.75F + 0.25F * hit.normal.z());
    const float sun = lit_[i] && !shadowed_[i] ? hit.normal.dot(to_sun) : 0.0F;
    return albedo * (sky + (1.0F - p_.ambient) * sun) + gloss(hit, d);
  }

  const RayScene& scene_;
  const Appearance& appearance_;
  const StereoCalibration& camera_;
  Vector3f begin_, way_;
  Eigen::Matrix3f R_, turn_;  // at the start of the exposure, and its change until the end
  float time_;
  const CameraParameters& p_;
  float fx_, fy_;
  std::vector<float> shift_;  // px, for each column
  Rays rays_, sun_rays_;
  Hits hits_;
  std::array<bool, packet> lit_{}, shadowed_{};
};

}  // namespace

GreyImage take_image(const RayScene& scene, const Appearance& appearance,
                     const StereoCalibration& camera, const CameraView& view, float time,
                     float brightness, std::uint64_t seed, const CameraParameters& p) {
  cv::Mat light = Sampling(scene, appearance, camera, view, time, p).light(seed);
  const std::array<float, 3> lens{p.blur, 1.0F - 2.0F * p.blur, p.blur};
  const cv::Mat kernel(1, 3, CV_32F, const_cast<float*>(lens.data()));
  cv::sepFilter2D(light, light, CV_32F, kernel, kernel);
  GreyImage image;
  image.resize(camera.width, camera.height);
  const std::uint64_t noise_seed = mix(seed, 12);
  auto to = image.pixels.begin();
  for (int y = 0; y < image.height; ++y) {
    const auto* from = light.ptr<float>(y);
    for (int x = 0; x < image.width; ++x) {
      const float grey = std::min(255.0F, p.exposure * brightness * from[x]);
      const float sigma = std::sqrt(p.read_noise * p.read_noise + p.shot_noise * grey);
      const float noise =
          sigma * grey_noise(mix(noise_seed, static_cast<std::uint64_t>(y * 4096 + x)));
      *to++ = static_cast<std::uint8_t>(std::clamp(grey + noise + 0.5F, 0.0F, 255.0F));
    }
  }
  return image;
}

}  // namespace maploop::simulate
