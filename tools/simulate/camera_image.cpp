#include "tools/simulate/camera_image.h"

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

// Standard normal of 64 random bits: the sum of their bytes, nearly.
float grey_noise(std::uint64_t bits) {
  std::uint64_t sum = (bits & 0x00ff00ff00ff00ffU) + (bits >> 8U & 0x00ff00ff00ff00ffU);
  sum = (sum & 0xffffU) + (sum >> 16U & 0xffffU) + (sum >> 32U & 0xffffU) + (sum >> 48U);
  return (static_cast<float>(sum) - 8.0F * 127.5F) / (73.9F * 2.828427F);
}

const Vector3f to_sun = Vector3f(0.4F, -0.45F, 0.8F).normalized();

// Paint and glass show something of the sky.
float gloss(const Hit& hit, const Vector3f& direction) {
  const Material material = hit.surface->material;
  if (material != Material::paint && material != Material::glass) return 0.0F;
  const float up = direction.z() - 2.0F * hit.normal.dot(direction) * hit.normal.z();
  return material == Material::glass ? 0.04F + 0.2F * std::max(0.0F, up)
                                     : 0.02F + 0.1F * std::max(0.0F, up);
}

// One sample of every pixel, in one half of the exposure.
class Sampling {
 public:
  Sampling(const RayScene& scene, const Appearance& appearance, const StereoCalibration& camera,
           const CameraView& view, float time, const CameraParameters& parameters)
      : scene_(scene),
        appearance_(appearance),
        camera_(camera),
        begin_(view.T_enu_cam[0].translation().cast<float>()),
        way_((view.T_enu_cam[1].translation() - view.T_enu_cam[0].translation()).cast<float>()),
        time_(time),
        p_(parameters),
        fx_(static_cast<float>(camera.fx)),
        fy_(static_cast<float>(camera.fy)) {
    for (std::size_t i = 0; i < 2; ++i) R_[i] = view.T_enu_cam[i].linear().cast<float>();
    shift_.resize(static_cast<std::size_t>(camera.width) + packet);
    for (std::size_t x = 0; x < shift_.size(); ++x)
      shift_[x] =
          view.shift *
          (1.0F + std::cos(7.0F * static_cast<float>(x) / static_cast<float>(camera.width)));
  }

  // Adds to `light`, where a white surface in the sun is 1 after both halves.
  void add(std::size_t half, std::uint64_t seed, cv::Mat& light) {
    for (int y = 0; y < camera_.height; ++y)
      for (int x = 0; x < camera_.width; x += static_cast<int>(packet)) {
        aim(half, x, y, seed);
        scene_.cast(rays_, p_.reach, hits_);
        find_shadows();
        const auto count = std::min(packet, static_cast<std::size_t>(camera_.width - x));
        for (std::size_t i = 0; i < count; ++i)
          light.at<float>(y, x + static_cast<int>(i)) += 0.5F * seen(i);
      }
  }

 private:
  void aim(std::size_t half, int x0, int y, std::uint64_t seed) {
    const auto cx = static_cast<float>(camera_.cx), cy = static_cast<float>(camera_.cy);
    const float side = 0.5F * static_cast<float>(half);
    for (std::size_t i = 0; i < packet; ++i) {
      const int x = x0 + static_cast<int>(i);
      const std::uint64_t bits = mix(seed, static_cast<std::uint64_t>(y * 4096 + x));
      const float u = static_cast<float>(x) + side + 0.5F * unit_float(bits) - 0.5F +
                      shift_[static_cast<std::size_t>(x)];
      const float v = static_cast<float>(y) + unit_float(bits << 24U) - 0.5F;
      const float moment = side + 0.5F * unit_float(bits << 48U);
      rays_[i] = {begin_ + moment * way_,
                  R_[half] * Vector3f((u - cx) / fx_, (v - cy) / fy_, 1.0F).normalized(), time_};
    }
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
    // The sky lights what faces up more than what faces down.
    const float sky = p_.ambient * (0.75F + 0.25F * hit.normal.z());
    const float sun = lit_[i] && !shadowed_[i] ? hit.normal.dot(to_sun) : 0.0F;
    return albedo * (sky + (1.0F - p_.ambient) * sun) + gloss(hit, d);
  }

  const RayScene& scene_;
  const Appearance& appearance_;
  const StereoCalibration& camera_;
  Vector3f begin_, way_;
  std::array<Eigen::Matrix3f, 2> R_;
  float time_;
  const CameraParameters& p_;
  float fx_, fy_;
  std::vector<float> shift_;  // px, by column
  Rays rays_, sun_rays_;
  Hits hits_;
  std::array<bool, packet> lit_{}, shadowed_{};
};

}  // namespace

GreyImage take_image(const RayScene& scene, const Appearance& appearance,
                     const StereoCalibration& camera, const CameraView& view, float time,
                     float brightness, std::uint64_t seed, const CameraParameters& p) {
  cv::Mat light = cv::Mat::zeros(camera.height, camera.width, CV_32F);
  Sampling sampling(scene, appearance, camera, view, time, p);
  for (std::size_t half = 0; half < 2; ++half) sampling.add(half, mix(seed, half), light);
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
