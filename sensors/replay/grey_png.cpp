#include "sensors/replay/grey_png.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

namespace maploop::sensors {

void decode_grey_png(const std::vector<char>& bytes, int width, int height, GreyImage& image) {
  if (bytes.empty()) throw std::runtime_error("the file is empty");
  // Of other formats a damaged image may decode to something; PNG has checksums.
  constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
  if (!std::string_view(bytes.data(), bytes.size()).starts_with(signature)) {
    throw std::runtime_error("is no PNG image");
  }
  // Not into a buffer of ours: where OpenCV finds no image it leaves that as it was, which looks
  // like success.
  cv::Mat decoded;
  try {
    decoded = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& error) {
    throw std::runtime_error("the image cannot be decoded: " + std::string(error.err));
  }
  if (decoded.empty()) throw std::runtime_error("the image is cut or damaged");
  if (decoded.type() != CV_8UC1) {
    throw std::runtime_error("not an 8-bit grey image (the grey cameras are image_00, image_01)");
  }
  if (decoded.cols != width || decoded.rows != height) {
    throw std::runtime_error("the image is " + std::to_string(decoded.cols) + " x " +
                             std::to_string(decoded.rows) + " pixels, the calibration says " +
                             std::to_string(width) + " x " + std::to_string(height));
  }
  image.resize(width, height);
  std::copy(decoded.datastart, decoded.dataend, image.pixels.begin());
}

}  // namespace maploop::sensors
