// Computes visual odometry from recorded stereo tracks, with the back end alone.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "estimators/stereo/parameters.h"
#include "msgs/odometry.h"
#include "runtime/vehicle/drivers/recorded_tracks.h"
#include "sensors/source.h"

namespace maploop::vehicle {

// Returns one motion for each frame from first_good_frame on. Its stamp is that of `stamps`, which
// has one for each frame, and it is available `delay` later.
std::unique_ptr<sensors::Source<RelativeMotion>> make_track_odometry(
    std::shared_ptr<const RecordedTracks> tracks, std::vector<Time> stamps,
    const stereo::StereoParameters& parameters, Duration delay);

}  // namespace maploop::vehicle
