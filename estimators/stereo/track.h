// Features are followed here from one pair to the next (internal: uses OpenCV).
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "estimators/stereo/stereo_match.h"
#include "estimators/stereo/tracks.h"
#include "msgs/calibration.h"

namespace maploop::stereo {

struct Feature {
  std::int64_t id = 0;
  StereoObservation seen;
};

template <class Archive>
void archive(Archive& ar, Feature& f) {
  ar(f.id, f.seen);
}

// Follows features by Lucas-Kanade and closes the circle (after Kitt, Geiger, Lategahn, IV 2010):
// left to left in time, left to right at the current epoch, and right to right in time, which must
// end where the second step ended. `expected`, T_current_previous in cam, gives the starting points
// if the motion can be predicted. Without it the whole pyramid is searched from the previous
// positions.
void track_features(const StereoCalibration& camera, const StereoParameters& parameters,
                    const StereoFrame& previous_frame, const StereoFrame& current_frame,
                    const std::vector<Feature>& features,
                    const std::optional<Eigen::Isometry3d>& expected,
                    std::vector<StereoTrack>* tracks);

}  // namespace maploop::stereo
