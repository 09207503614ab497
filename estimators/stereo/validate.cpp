#include "estimators/stereo/validate.h"

#include <stdexcept>
#include <string>

namespace maploop::stereo {
namespace {

void require(bool holds, const char* what, const char* must, double value) {
  if (!holds)
    throw std::invalid_argument("stereo odometry: " + std::string(what) + " must be " + must +
                                ", not " + std::to_string(value));
}

void require_positive(const char* what, double value) {
  require(value > 0.0, what, "positive", value);
}

}  // namespace

void validate(const StereoCalibration& calibration) {
  const double smallest = 64.0;  // below this no pyramid of the default height
  require(calibration.width >= smallest, "calibration width", "at least 64 px", calibration.width);
  require(calibration.height >= smallest, "calibration height", "at least 64 px",
          calibration.height);
  require_positive("calibration fx", calibration.fx);
  require_positive("calibration fy", calibration.fy);
  require_positive("calibration baseline (m, right camera to the right)", calibration.baseline);
}

bool has_size(const GreyImage& image, const StereoCalibration& calibration) {
  return image.width == calibration.width && image.height == calibration.height &&
         image.pixels.size() ==
             static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

}  // namespace maploop::stereo
