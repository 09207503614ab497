#include "runtime/vehicle/drivers/track_odometry.h"

#include <algorithm>
#include <utility>

#include "estimators/stereo/back_end.h"

namespace maploop::vehicle {
namespace {

class TrackOdometry final : public sensors::Source<RelativeMotion> {
 public:
  TrackOdometry(std::shared_ptr<const RecordedTracks> tracks, std::vector<Time> stamps,
                const stereo::StereoParameters& parameters, Duration delay)
      : tracks_(std::move(tracks)),
        stamps_(std::move(stamps)),
        back_end_(tracks_->calibration, parameters),
        delay_(delay),
        first_(tracks_->first_good_frame),
        frame_(first_) {}

  bool next(RelativeMotion& motion) override {
    if (frame_ >= std::min(tracks_->frames.size(), stamps_.size())) return false;
    motion = {};
    motion.stamp = stamps_[frame_];
    motion.available = motion.stamp + delay_;
    motion.sequence = frame_;
    if (frame_ > first_) {
      motion.from = stamps_[frame_ - 1];
      back_end_.process(tracks_->between(frame_ - 1, frame_), &motion);
    }
    ++frame_;
    ++report_.delivered;
    return true;
  }

  const sensors::SourceReport& report() const override { return report_; }

 private:
  std::shared_ptr<const RecordedTracks> tracks_;
  std::vector<Time> stamps_;
  stereo::BackEnd back_end_;
  Duration delay_;
  std::size_t first_;
  std::size_t frame_;
  sensors::SourceReport report_;
};

}  // namespace

std::unique_ptr<sensors::Source<RelativeMotion>> make_track_odometry(
    std::shared_ptr<const RecordedTracks> tracks, std::vector<Time> stamps,
    const stereo::StereoParameters& parameters, Duration delay) {
  return std::make_unique<TrackOdometry>(std::move(tracks), std::move(stamps), parameters, delay);
}

}  // namespace maploop::vehicle
