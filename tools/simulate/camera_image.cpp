#include "tools/simulate/camera_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/simulate/random.h"

namespace maploop::simulate {
namespace {

using Eigen::Vector3f;

float uniform(std::uint64_t bits) {
  return static_cast<float>(unit(bits));
}

// Standard normal of 64 random bits: the sum of their bytes, nearly.
float normal(std::uint64_t bits) {
  std::uint64_t sum = (bits & 0x00ff00ff00ff00ffU) + (bits >> 8U & 0x00ff00ff00ff00ffU);
  sum = (sum & 0xffffU) + (sum >> 16U & 0xffffU) + (sum >> 32U & 0xffffU) + (sum >> 48U);
  return (static_cast<float>(sum) - 8.0F * 127.5F) / (73.9F * 2.828427F);
}

const Vector3f to_sun = Vector3f(0.45F, -0.55F, 0.7F).normalized();

// Light from the scene, 1 of a white surface in the sun.
cv::Mat radiance(const RayScene& scene, const Appearance& appearance,
                 const StereoCalibration& camera, const Eigen::Isometry3d& T_enu_cam, float time,
                 std::uint64_t seed, const CameraParameters& p) {
  cv::Mat light(camera.height, camera.width, CV_32F);
  const Eigen::Matrix3f R = T_enu_cam.linear().cast<float>();
  const Vector3f origin = T_enu_cam.translation().cast<float>();
  const float fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
  const float cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
  Rays rays, sun_rays;
  Hits hits;
  std::array<bool, packet> lit{}, shadowed{};
  for (int y = 0; y < camera.height; ++y) {
    auto* row = light.ptr<float>(y);
    for (int x0 = 0; x0 < camera.width; x0 += static_cast<int>(packet)) {
      for (std::size_t i = 0; i < packet; ++i) {
        const int x = x0 + static_cast<int>(i);
        const std::uint64_t bits = mix(seed, static_cast<std::uint64_t>(y * 4096 + x));
        const float u = static_cast<float>(x) + uniform(bits) - 0.5F;
        const float v = static_cast<float>(y) + uniform(bits << 32U) - 0.5F;
        rays[i] = {origin, R * Vector3f((u - cx) / fx, (v - cy) / fy, 1.0F).normalized(), time};
      }
      scene.cast(rays, p.reach, hits);
      for (std::size_t i = 0; i < packet; ++i) {
        lit[i] = hits[i].any && hits[i].normal.dot(to_sun) > 0.0F;
        if (!lit[i]) continue;
        const Vector3f place = origin + hits[i].range * rays[i].direction;
        sun_rays[i] = {place + 0.01F * hits[i].normal, to_sun, time};
      }
      scene.occluded(sun_rays, lit, shadowed);
      const auto count =
          static_cast<std::size_t>(std::min(static_cast<int>(packet), camera.width - x0));
      for (std::size_t i = 0; i < count; ++i) {
        const Hit& hit = hits[i];
        const Vector3f& d = rays[i].direction;
        if (!hit.any) {
          row[x0 + static_cast<int>(i)] = 0.8F * appearance.sky(d);
          continue;
        }
        const float slant = std::max(0.04F, -hit.normal.dot(d));
        const float footprint = hit.range / fx / std::sqrt(slant);
        const float albedo =
            appearance.albedo(*hit.surface, hit.uv, origin + hit.range * d, footprint);
        // The sky lights what faces up more than what faces down.
        const float sky = p.ambient * (0.75F + 0.25F * hit.normal.z());
        const float sun = lit[i] && !shadowed[i] ? hit.normal.dot(to_sun) : 0.0F;
        row[x0 + static_cast<int>(i)] = albedo * (sky + (1.0F - p.ambient) * sun);
      }
    }
  }
  return light;
}

}  // namespace

cv::Mat take_image(const RayScene& scene, const Appearance& appearance,
                   const StereoCalibration& camera, const Eigen::Isometry3d& T_enu_cam, float time,
                   float brightness, std::uint64_t pixel_seed, const CameraParameters& p) {
  cv::Mat light = radiance(scene, appearance, camera, T_enu_cam, time, pixel_seed, p);
  const std::array<float, 3> lens{p.blur, 1.0F - 2.0F * p.blur, p.blur};
  const cv::Mat kernel(1, 3, CV_32F, const_cast<float*>(lens.data()));
  cv::sepFilter2D(light, light, CV_32F, kernel, kernel);
  cv::Mat image(light.size(), CV_8U);
  const std::uint64_t noise_seed = mix(pixel_seed, 12);
  for (int y = 0; y < image.rows; ++y) {
    const auto* from = light.ptr<float>(y);
    auto* to = image.ptr<std::uint8_t>(y);
    for (int x = 0; x < image.cols; ++x) {
      const float grey = std::min(255.0F, p.exposure * brightness * from[x]);
      const float sigma = std::sqrt(p.read_noise * p.read_noise + p.shot_noise * grey);
      const float noise = sigma * normal(mix(noise_seed, static_cast<std::uint64_t>(y * 4096 + x)));
      to[x] = static_cast<std::uint8_t>(std::clamp(grey + noise + 0.5F, 0.0F, 255.0F));
    }
  }
  return image;
}

}  // namespace maploop::simulate
