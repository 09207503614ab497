#include "tools/odometry/stereo_runs.h"

#include <time.h>

#include <algorithm>
#include <stdexcept>

#include "estimators/lidar/visual_lidar_odometer.h"
#include "estimators/stereo/back_end.h"
#include "estimators/stereo/stereo_odometry.h"

namespace maploop::odometry {
namespace {

// Measures the time of one estimate and of its stages.
class Stopwatch {
 public:
  explicit Stopwatch(Step* step) : step_(step), start_(processor_milliseconds()), lap_(start_) {}

  void stage(std::string_view name) {
    const double now = processor_milliseconds();
    step_->stages.emplace_back(name, now - lap_);
    lap_ = now;
  }
  void stop() { step_->milliseconds = processor_milliseconds() - start_; }

 private:
  Step* step_;
  double start_, lap_;
};

// Calls the function that makes one step, and measures its stages.
template <class Odometry, class Estimate>
void measure(Odometry& odometry, Step* step, const Estimate& estimate) {
  Stopwatch watch(step);
  odometry.on_stage([&watch](std::string_view name) { watch.stage(name); });
  estimate();
  watch.stop();
  odometry.on_stage({});
}

}  // namespace

double processor_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

FrameScans::FrameScans(std::unique_ptr<sensors::Source<LidarScan>> scans)
    : scans_(std::move(scans)) {
  if (scans_ == nullptr) throw std::runtime_error("the recording has no scans of a LiDAR");
}

const LidarScan* FrameScans::of(Time stamp) {
  while (!ended_ && (!loaded_ || scan_.end <= stamp)) {
    loaded_ = scans_->next(scan_);
    ended_ = !loaded_;
  }
  return loaded_ && scan_.start <= stamp ? &scan_ : nullptr;
}

Run stereo_run(const vehicle::Recording& recording, const stereo::StereoParameters& parameters,
               FrameRange frames, const std::optional<lidar::LidarParameters>& depth) {
  struct Depth {
    FrameScans scans;
    lidar::VisualLidarOdometer odometer;
  };
  struct State {
    stereo::StereoOdometry odometry;
    std::unique_ptr<sensors::Source<StereoPair>> camera;
    std::optional<Depth> depth;
    StereoPair pair;
  };
  const VehicleCalibration& calibration = recording.calibration;
  vehicle::Sensors sensors = recording.sensors(Time::min());
  if (sensors.camera == nullptr)
    throw std::runtime_error("the recording has no images of a pair of cameras");
  auto state = std::make_shared<State>(
      State{{calibration.stereo, parameters}, std::move(sensors.camera), {}, {}});
  if (depth) {
    state->depth.emplace(
        Depth{FrameScans(std::move(sensors.velodyne)), {calibration.T_body_velo, *depth}});
  }
  return [state, frames]() -> std::optional<Step> {
    do {
      if (!state->camera->next(state->pair)) return std::nullopt;
    } while (state->pair.sequence < frames.first);
    if (state->pair.sequence > frames.last) return std::nullopt;
    Step step;
    step.frame = state->pair.sequence;
    VisualMotion motion;
    measure(state->odometry, &step, [&] { motion = state->odometry.process(state->pair); });
    step.motion = motion;
    if (state->depth) {
      Depth& known = *state->depth;
      step.motion = known.odometer.correction().correct(motion);
      known.odometer.process(known.scans.of(state->pair.stamp), &motion);
    }
    const auto tracks = state->odometry.tracks();
    step.tracks.assign(tracks.begin(), tracks.end());
    return step;
  };
}

Run tracks_run(std::shared_ptr<const RecordedTracks> tracks,
               const stereo::StereoParameters& parameters, FrameRange frames) {
  auto back_end = std::make_shared<stereo::BackEnd>(tracks->calibration, parameters);
  const std::size_t first = std::max(frames.first, tracks->first_good_frame);
  return [tracks, back_end, frames, first, frame = first]() mutable -> std::optional<Step> {
    if (frame >= tracks->frames.size() || frame > frames.last) return std::nullopt;
    Step step;
    step.frame = frame;
    step.motion.sequence = frame;
    step.motion.stamp = step.motion.available = tracks->stamps[frame];
    if (frame > first) {
      step.motion.from = tracks->stamps[frame - 1];
      step.tracks = tracks->between(frame - 1, frame);
      measure(*back_end, &step, [&] { back_end->process(step.tracks, &step.motion); });
    }
    ++frame;
    return step;
  };
}

}  // namespace maploop::odometry
