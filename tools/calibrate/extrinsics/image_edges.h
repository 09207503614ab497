// This file shows where an image has vertical edges.
#pragma once

#include "msgs/image.h"

namespace maploop::extrinsics {

// Returns for each pixel how near the next strong vertical edge of its row is: 255 on it, a tenth
// less with each pixel beside it, and less for weak edges (after Levinson and Thrun, "Automatic
// Online Calibration of Cameras and Lasers", RSS 2013). An edge is strong if the grey changes four
// times as much as on the image's average.
GreyImage vertical_edges(const GreyImage& image);

}  // namespace maploop::extrinsics
