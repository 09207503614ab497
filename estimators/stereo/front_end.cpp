#include "estimators/stereo/front_end.h"

#include "estimators/stereo/klt_front_end.h"
#include "estimators/stereo/sift_front_end.h"

namespace maploop::stereo {

std::unique_ptr<FrontEnd> make_front_end(const StereoCalibration& camera,
                                         const StereoParameters& parameters) {
  if (parameters.matching == Matching::sift)
    return std::make_unique<SiftFrontEnd>(camera, parameters);
  return std::make_unique<KltFrontEnd>(camera, parameters);
}

}  // namespace maploop::stereo
