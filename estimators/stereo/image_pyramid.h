// This header provides image pyramids and Lucas-Kanade flow between them (internal: uses OpenCV).
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "estimators/stereo/image_view.h"
#include "estimators/stereo/parameters.h"
#include "msgs/image.h"

namespace maploop::stereo {

// Holds one image with its coarser copies and their gradients, which are computed once for all
// flows that start or end here. Building again reuses the buffers.
class ImagePyramid {
 public:
  void build(const ImageView& image, const StereoParameters& parameters);

  // Copies out the image from which the pyramid was built.
  void copy_image(GreyImage* image) const;

  const cv::Mat& level(int i) const { return levels_[2 * static_cast<std::size_t>(i)]; }
  // Returns the Scharr derivatives (x, y; 16 bit, 32 times the grey levels per pixel).
  const cv::Mat& gradient(int i) const { return levels_[2 * static_cast<std::size_t>(i) + 1]; }
  const std::vector<cv::Mat>& levels() const { return levels_; }

 private:
  std::vector<cv::Mat> levels_;  // level 0, its gradient, level 1, its gradient, ...
};

// Tracks points by pyramidal Lucas-Kanade (Bouguet, "Pyramidal Implementation of the Lucas Kanade
// Feature Tracker", 2000). `to` holds the initial positions on entry and the results on return, px.
// found[i] is 0 if the window left the image or has no texture. `coarsest` is the number of levels
// used above the full image.
void track_points(const ImagePyramid& from_image, const ImagePyramid& to_image, int coarsest,
                  const StereoParameters& parameters, const std::vector<cv::Point2f>& from,
                  std::vector<cv::Point2f>* to, std::vector<unsigned char>* found);

}  // namespace maploop::stereo
