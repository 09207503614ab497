// This file finds sensors whose values are cut off at the end of their range.
#pragma once

#include <string>
#include <vector>

#include "runtime/vehicle/drivers/recording.h"
#include "tools/calibrate/extrinsics/sensor_motions.h"

namespace maploop::tools {

// Returns whether values pile up at their largest or smallest: at least five are exactly the same
// there, and more than three times as many as each of the three values next to it. Values of a
// sensor that is frozen do not count.
bool is_cut_off(std::vector<double> values);

// Returns a sentence for each axis of the inertial unit that is cut off. A unit whose mount is
// found on the way is not examined: its samples are no longer in its own axes.
std::vector<std::string> cut_off_axes(const vehicle::Recording& recording);

// Returns a sentence if more than a quarter of the left images' pixels, over the stretch, are
// entirely white or entirely black.
std::vector<std::string> cut_off_images(const vehicle::Recording& recording,
                                        const extrinsics::Stretch& stretch);

}  // namespace maploop::tools
