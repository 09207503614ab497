// Odometries that run alone, one motion a frame.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>

#include "estimators/stereo/parameters.h"
#include "msgs/odometry.h"
#include "sensors/replay/kitti_drive.h"
#include "tools/odometry/recorded_tracks.h"

namespace maploop::odometry {

// Frames of a drive, by their numbers; both ends belong to it.
struct FrameRange {
  std::size_t first = 0;
  std::size_t last = std::numeric_limits<std::size_t>::max();
};

struct Step {
  std::size_t frame = 0;
  RelativeMotion motion;
  double milliseconds = 0.0;  // that the estimate took, reading not counted
};

// The next step; nothing at the end.
using Run = std::function<std::optional<Step>()>;

// Visual odometry from a drive's images. `drive` must outlive the run.
Run stereo_run(const sensors::KittiDrive& drive, const stereo::StereoParameters& parameters,
               FrameRange frames);

// The same from recorded tracks: frames before first_good_frame are passed over.
Run tracks_run(std::shared_ptr<const RecordedTracks> tracks,
               const stereo::StereoParameters& parameters, FrameRange frames);

}  // namespace maploop::odometry
