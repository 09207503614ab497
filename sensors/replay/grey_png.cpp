#include "sensors/replay/grey_png.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>

namespace maploop::sensors {

void decode_grey_png(const std::vector<char>& bytes, int width, int height, GreyImage& image) {
  if (bytes.empty()) throw std::runtime_error("the file is empty");
  image.resize(width, height);
  // Wraps the buffer: decoding an image of this size and type writes straight into it.
  cv::Mat decoded(height, width, CV_8UC1, image.pixels.data());
  try {
    cv::imdecode(bytes, cv::IMREAD_UNCHANGED, &decoded);
  } catch (const cv::Exception& error) {
    throw std::runtime_error("the image cannot be decoded: " + std::string(error.err));
  }
  if (decoded.empty()) throw std::runtime_error("the image is cut or damaged, or is no image");
  if (decoded.type() != CV_8UC1) {
    throw std::runtime_error("not an 8-bit grey image (the grey cameras are image_00, image_01)");
  }
  if (decoded.cols != width || decoded.rows != height) {
    throw std::runtime_error("the image is " + std::to_string(decoded.cols) + " x " +
                             std::to_string(decoded.rows) + " pixels, the calibration says " +
                             std::to_string(width) + " x " + std::to_string(height));
  }
}

}  // namespace maploop::sensors
