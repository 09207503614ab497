// Image pyramids and Lucas-Kanade flow between them (internal: uses OpenCV).
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "msgs/image.h"

namespace maploop::stereo {

// One image with its coarser copies and their gradients, computed once and used by every flow that
// starts or ends here. Rebuilding reuses the buffers.
class ImagePyramid {
 public:
  void build(const GreyImage& image, const StereoParameters& parameters);

  // The image it was built from.
  void copy_image(GreyImage* image) const;

  const cv::Mat& level(int i) const { return levels_[2 * static_cast<std::size_t>(i)]; }
  // Scharr derivatives (x, y; 16 bit, 32 times the grey levels per pixel).
  const cv::Mat& gradient(int i) const { return levels_[2 * static_cast<std::size_t>(i) + 1]; }
  const std::vector<cv::Mat>& levels() const { return levels_; }

 private:
  std::vector<cv::Mat> levels_;  // level 0, its gradient, level 1, its gradient, ...
};

// Pyramidal Lucas-Kanade (Bouguet, "Pyramidal Implementation of the Lucas Kanade Feature Tracker",
// 2000). `to` holds the guesses on entry and the results on return; found[i] is 0 where the window
// left the image or has no texture. `coarsest`: levels above the full image that are used.
void track_points(const ImagePyramid& from_image, const ImagePyramid& to_image, int coarsest,
                  const StereoParameters& parameters, const std::vector<cv::Point2f>& from,
                  std::vector<cv::Point2f>* to, std::vector<unsigned char>* found);

}  // namespace maploop::stereo
