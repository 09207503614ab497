#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sensors/camera/rectifier.h"
#include "sensors/live/live_sensors.h"
#include "sensors/live/video_pipeline.h"

namespace maploop::sensors {
namespace {

// Holds images of one camera that wait for their partners.
class Waiting {
 public:
  bool empty() const { return count_ == 0; }
  VideoFrame& oldest() { return frames_[first_]; }
  void drop_oldest() {
    first_ = (first_ + 1) % frames_.size();
    --count_;
  }
  // Returns the place of the next image; if there is no room, the oldest one is dropped.
  VideoFrame& next(std::uint64_t& alone) {
    if (count_ == frames_.size()) {
      drop_oldest();
      ++alone;
    }
    return frames_[(first_ + count_) % frames_.size()];
  }
  void keep() { ++count_; }

 private:
  std::array<VideoFrame, 4> frames_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

// Splits one image into its left and right half.
void halve(const GreyImage& both, GreyImage& left, GreyImage& right) {
  const int width = both.width / 2;
  left.resize(width, both.height);
  right.resize(width, both.height);
  const auto half = static_cast<std::size_t>(width);
  for (std::size_t y = 0; y < static_cast<std::size_t>(both.height); ++y) {
    const std::uint8_t* row = both.pixels.data() + y * static_cast<std::size_t>(both.width);
    std::memcpy(left.pixels.data() + y * half, row, half);
    std::memcpy(right.pixels.data() + y * half, row + half, half);
  }
}

class LiveStereo final : public LiveSource<StereoPair> {
 public:
  LiveStereo(LiveStereoOptions options, const HostClock& clock)
      : clock_(clock), options_(std::move(options)), left_(options_.left, clock) {
    if (!options_.right.empty()) right_.emplace(options_.right, clock);
    if (options_.rig) rectifier_.emplace(*options_.rig);
  }

  bool wait(StereoPair& pair, Duration patience) override {
    const Time end = clock_.now() + patience;
    do {
      const Duration left = std::max(Duration::zero(), end - clock_.now());
      if (right_ ? wait_for_two(left, pair) : wait_for_both(left, pair)) return true;
    } while (clock_.now() < end);
    return false;
  }

  LiveReport report() const override {
    const VideoState& first = left_.state();
    LiveReport report{without_secrets(left_.description()), first.connection, delivered_};
    if (right_) {
      const VideoState& second = right_->state();
      report.endpoint += " | " + without_secrets(right_->description());
      report.connection.open = first.connection.open && second.connection.open;
      report.connection.opened = std::min(first.connection.opened, second.connection.opened);
      report.connection.bytes += second.connection.bytes;
      if (report.connection.problem.empty() && !second.connection.problem.empty())
        report.connection.problem = "right camera " + second.connection.problem;
      report.lose(second.lost, "right images lost by the driver");
      report.note(second.unstamped, "right images stamped on arrival");
    }
    report.lose(first.lost, "images lost by the driver");
    report.lose(alone_, "images without a partner");
    report.refuse(wrong_size_, "pairs whose size differs from the calibration's");
    report.refuse(not_later_, "pairs not later than the one before");
    report.note(first.frames, "images");
    report.note(first.unstamped, "images stamped on arrival");
    return report;
  }

 private:
  bool wait_for_both(Duration patience, StereoPair& pair) {
    if (!left_.read(both_, patience)) return false;
    StereoPair& raw = rectifier_ ? raw_ : pair;
    halve(both_.image, raw.left, raw.right);
    raw.stamp = both_.stamp;
    return deliver(raw, pair);
  }

  bool wait_for_two(Duration patience, StereoPair& pair) {
    // Each camera gets half of the time, because both expose at the same moment.
    fetch(left_, lefts_, patience / 2);
    fetch(*right_, rights_, patience / 2);
    while (!lefts_.empty() && !rights_.empty()) {
      VideoFrame& left = lefts_.oldest();
      VideoFrame& right = rights_.oldest();
      const Duration skew = right.stamp - left.stamp;
      if (skew > options_.max_skew || skew < -options_.max_skew) {
        (skew > Duration::zero() ? lefts_ : rights_).drop_oldest();
        ++alone_;
        continue;
      }
      StereoPair& raw = rectifier_ ? raw_ : pair;
      std::swap(raw.left, left.image);
      std::swap(raw.right, right.image);
      raw.stamp = std::min(left.stamp, right.stamp);
      lefts_.drop_oldest();
      rights_.drop_oldest();
      return deliver(raw, pair);
    }
    return false;
  }

  void fetch(VideoPipeline& camera, Waiting& waiting, Duration patience) {
    if (camera.read(waiting.next(alone_), patience)) waiting.keep();
  }

  bool deliver(StereoPair& raw, StereoPair& pair) {
    for (const GreyImage* image : {&raw.left, &raw.right}) {
      if (image->width == options_.width && image->height == options_.height) continue;
      ++wrong_size_;
      return false;
    }
    raw.stamp -= options_.delay;
    if (raw.stamp <= last_stamp_) {
      ++not_later_;
      return false;
    }
    last_stamp_ = raw.stamp;
    if (rectifier_) rectifier_->rectify(raw, pair);
    pair.stamp = last_stamp_;
    pair.sequence = delivered_++;
    pair.available = last_available_ = std::max(clock_.now(), last_available_ + Duration(1));
    return true;
  }

  const HostClock& clock_;
  LiveStereoOptions options_;
  VideoPipeline left_;
  std::optional<VideoPipeline> right_;
  std::optional<Rectifier> rectifier_;
  Waiting lefts_, rights_;
  VideoFrame both_;
  StereoPair raw_;
  std::uint64_t delivered_ = 0, alone_ = 0, wrong_size_ = 0, not_later_ = 0;
  Time last_stamp_ = Time::min(), last_available_ = Time::min();
};

}  // namespace

std::unique_ptr<LiveSource<StereoPair>> listen_to_cameras(LiveStereoOptions options,
                                                          const HostClock& clock) {
  if (options.width <= 0 || options.height <= 0) {
    throw std::invalid_argument(
        "the cameras' calibration is missing: set [vehicle.camera] calibration to a file of "
        "'maploop "
        "calibrate', or width, height, fx, fy, cx, cy and baseline to those of rectified images");
  }
  return std::make_unique<LiveStereo>(std::move(options), clock);
}

}  // namespace maploop::sensors
