#include "estimators/stereo/image_pyramid.h"

#include <opencv2/video/tracking.hpp>

namespace maploop::stereo {

void ImagePyramid::build(const ImageView& image, const StereoParameters& parameters) {
  // OpenCV offers no view of constant pixels; here it only reads them.
  const cv::Mat view(image.height, image.width, CV_8UC1, const_cast<unsigned char*>(image.pixels));
  cv::buildOpticalFlowPyramid(view, levels_, cv::Size(parameters.window, parameters.window),
                              parameters.pyramid_levels, true, cv::BORDER_REFLECT_101,
                              cv::BORDER_CONSTANT, false);
}

void ImagePyramid::copy_image(GreyImage* image) const {
  image->resize(level(0).cols, level(0).rows);
  level(0).copyTo(cv::Mat(image->height, image->width, CV_8UC1, image->pixels.data()));
}

void track_points(const ImagePyramid& from_image, const ImagePyramid& to_image, int coarsest,
                  const StereoParameters& parameters, const std::vector<cv::Point2f>& from,
                  std::vector<cv::Point2f>* to, std::vector<unsigned char>* found) {
  found->clear();
  if (from.empty()) return;
  cv::calcOpticalFlowPyrLK(from_image.levels(), to_image.levels(), from, *to, *found, cv::noArray(),
                           cv::Size(parameters.window, parameters.window), coarsest,
                           cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS,
                                            parameters.max_iterations, parameters.min_step),
                           cv::OPTFLOW_USE_INITIAL_FLOW);
}

}  // namespace maploop::stereo
