// These methods of matching features and finding the motion can be selected (thesis 3.10 and 3.15).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace maploop::stereo {

// Selects how features are found again in other images.
enum class Matching : std::uint8_t {
  klt,   // corners followed by Lucas-Kanade (klt_front_end.h)
  sift,  // matched descriptors (sift_front_end.h)
};

// Selects how a motion is estimated from the matched features.
enum class MotionMethod : std::uint8_t {
  points_to_image,   // 3D-to-2D: P3P, then both images (ransac.h, refine.h)
  points_to_points,  // 3D-to-3D: closed form, then the points' own covariances (point_alignment.h)
  image_to_image,  // 2D-to-2D: essential matrix of the left camera, which does not give the length
                   // of a motion (epipolar_motion.h)
};

// These are the names in configuration files and on the command line, in the order of the
// enumerators.
constexpr std::array<std::string_view, 2> names_of(Matching) {
  return {"klt", "sift"};
}
constexpr std::array<std::string_view, 3> names_of(MotionMethod) {
  return {"3d-2d", "3d-3d", "2d-2d"};
}

}  // namespace maploop::stereo
