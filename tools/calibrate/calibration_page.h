// A calibration as a page of pictures that needs nothing but a browser.
#pragma once

#include <string>
#include <vector>

#include "tools/calibrate/calibration.h"
#include "tools/calibrate/image_pairs.h"

namespace maploop::calibrate {

// `pairs`: of every view that was found, by its name. Images that cannot be read again are left
// out.
std::string to_page(const StereoResult& result, const std::vector<ImagePair>& pairs,
                    const std::vector<Unusable>& unusable);

}  // namespace maploop::calibrate
