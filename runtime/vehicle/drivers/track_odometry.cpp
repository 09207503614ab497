#include "runtime/vehicle/drivers/track_odometry.h"

#include <algorithm>
#include <utility>

#include "estimators/stereo/back_end.h"

namespace maploop::vehicle {

std::unique_ptr<sensors::Source<RelativeMotion>> make_track_odometry(
    std::shared_ptr<const RecordedTracks> tracks, std::vector<Time> stamps,
    const stereo::StereoParameters& parameters, Duration delay) {
  const std::size_t first = tracks->first_good_frame;
  stereo::BackEnd back_end(tracks->calibration, parameters);
  return sensors::made<RelativeMotion>(
      [tracks = std::move(tracks), stamps = std::move(stamps), back_end = std::move(back_end),
       delay, first, frame = first](RelativeMotion& motion, sensors::SourceReport&) mutable {
        if (frame >= std::min(tracks->frames.size(), stamps.size())) return false;
        motion = {};
        motion.stamp = stamps[frame];
        motion.available = motion.stamp + delay;
        motion.sequence = frame;
        if (frame > first) {
          motion.from = stamps[frame - 1];
          back_end.process(tracks->between(frame - 1, frame), &motion);
        }
        ++frame;
        return true;
      });
}

}  // namespace maploop::vehicle
