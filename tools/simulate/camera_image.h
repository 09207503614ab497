// What a camera of the vehicle sees.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "msgs/calibration.h"
#include "tools/simulate/appearance.h"
#include "tools/simulate/ray_scene.h"

namespace maploop::simulate {

struct CameraParameters {
  float exposure = 330.0F;   // grey levels of a white surface in the sun
  float ambient = 0.5F;      // light of the sky, as a share of sun and sky
  float read_noise = 1.0F;   // grey levels, 1 sigma
  float shot_noise = 0.02F;  // grey levels of variance, each grey level
  float blur = 0.2F;     // share of a pixel's light in each of its 4 neighbours' rows or columns
  float reach = 400.0F;  // m
};

// A rectified grey image from T_enu_cam, `pixel_seed` making its noise: one ray through a random
// place of each pixel, sun and shadow, the blur of a lens, photon and read noise, 8 bits.
cv::Mat take_image(const RayScene& scene, const Appearance& appearance,
                   const StereoCalibration& camera, const Eigen::Isometry3d& T_enu_cam, float time,
                   float brightness, std::uint64_t pixel_seed,
                   const CameraParameters& parameters = {});

}  // namespace maploop::simulate
