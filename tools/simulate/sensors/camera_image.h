// Simulates the image that a camera of the vehicle takes.
#pragma once

#include <array>
#include <cstdint>

#include "msgs/calibration.h"
#include "msgs/image.h"
#include "tools/simulate/scene/appearance.h"
#include "tools/simulate/scene/ray_scene.h"
#include "tools/simulate/sensors/calibration_errors.h"

namespace maploop::simulate {

struct CameraParameters {
  float exposure = 400.0F;       // grey levels of a white surface in the sun
  double exposure_time = 0.002;  // s
  float ambient = 0.5F;          // light of the sky, as a share of sun and sky
  float read_noise = 1.0F;       // grey levels, 1 sigma
  float shot_noise = 0.02F;      // grey levels of variance for each grey level
  float blur = 0.2F;  // share of a pixel's light that reaches each neighbour along a row or column
  float reach = 400.0F;  // m
};

// Where one camera of the pair is during an exposure, and the error of its calibration.
struct CameraView {
  std::array<Eigen::Isometry3d, 2> T_enu_cam;  // at start and end of the exposure
  // How much further left than the calibration predicts things appear in the image: the error that
  // rectification leaves.
  ColumnShift shift;
};

// Returns a rectified grey image of 8 bits; `seed` draws its noise. One ray is cast through a
// random place of each pixel at a random moment of the exposure, and a second one if neighbouring
// rays hit different surfaces or the image moves meanwhile. Sun and shadow, the blur of a lens,
// photon and read noise are included. `time` (0 to 1) is that of the moving bodies, `brightness` a
// factor of the exposure.
GreyImage take_image(const RayScene& scene, const Appearance& appearance,
                     const StereoCalibration& camera, const CameraView& view, float time,
                     float brightness, std::uint64_t seed, const CameraParameters& parameters = {});

}  // namespace maploop::simulate
