// Formats a calibration as a page of pictures that only needs a browser.
#pragma once

#include <string>
#include <vector>

#include "tools/calibrate/calibration.h"
#include "tools/calibrate/image_pairs.h"

namespace maploop::calibrate {

// `pairs` holds the image files of the views, found by name. Images that can no longer be read are
// left out.
std::string to_page(const StereoResult& result, const std::vector<ImagePair>& pairs,
                    const std::vector<Unusable>& unusable);

}  // namespace maploop::calibrate
