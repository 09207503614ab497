#include "tools/odometry/stereo_runs.h"

#include <algorithm>
#include <chrono>

#include "estimators/stereo/back_end.h"
#include "estimators/stereo/stereo_odometry.h"

namespace maploop::odometry {
namespace {

class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

Run stereo_run(const sensors::KittiDrive& drive, const stereo::StereoParameters& parameters,
               FrameRange frames) {
  struct State {
    stereo::StereoOdometry odometry;
    std::unique_ptr<sensors::Source<StereoPair>> camera;
    StereoPair pair;
  };
  auto state =
      std::make_shared<State>(State{{drive.calibration().stereo, parameters}, drive.camera(), {}});
  return [state, frames]() -> std::optional<Step> {
    do
      if (!state->camera->next(state->pair)) return std::nullopt;
    while (state->pair.sequence < frames.first);
    if (state->pair.sequence > frames.last) return std::nullopt;
    const Stopwatch watch;
    Step step{state->pair.sequence, state->odometry.process(state->pair)};
    step.milliseconds = watch.milliseconds();
    return step;
  };
}

Run tracks_run(std::shared_ptr<const RecordedTracks> tracks,
               const stereo::StereoParameters& parameters, FrameRange frames) {
  auto back_end = std::make_shared<stereo::BackEnd>(tracks->calibration, parameters);
  const std::size_t first = std::max(frames.first, tracks->first_good_frame);
  return [tracks, back_end, frames, first, frame = first]() mutable -> std::optional<Step> {
    if (frame >= tracks->frames.size() || frame > frames.last) return std::nullopt;
    Step step{frame, {}};
    step.motion.sequence = frame;
    step.motion.stamp = step.motion.available = tracks->stamps[frame];
    if (frame > first) {
      step.motion.from = tracks->stamps[frame - 1];
      const auto seen = tracks->between(frame - 1, frame);
      const Stopwatch watch;
      back_end->process(seen, &step.motion);
      step.milliseconds = watch.milliseconds();
    }
    ++frame;
    return step;
  };
}

}  // namespace maploop::odometry
