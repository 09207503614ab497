#include "tools/odometry/lidar_run.h"

#include <stdexcept>
#include <utility>

#include "estimators/stereo/stereo_odometry.h"

namespace maploop::odometry {
namespace {

lidar::LidarParameters seeded(const LidarRunParameters& parameters) {
  lidar::LidarParameters p = parameters.lidar;
  p.constant_motion = p.constant_motion && parameters.seed != LidarSeed::none;
  return p;
}

}  // namespace

LidarFrames drive_frames(const vehicle::Recording& recording,
                         const LidarRunParameters& parameters) {
  struct State {
    std::unique_ptr<sensors::Source<StereoPair>> camera;
    FrameScans scans;
    stereo::StereoOdometry stereo;
    StereoPair pair;
    std::optional<std::size_t> first;
  };
  const bool visual = parameters.seed == LidarSeed::vo;
  // Without a visual seed no pixel is read.
  vehicle::Sensors sensors = recording.sensors(Time::min());
  if (!visual) sensors.camera = recording.sensors(Time::max()).camera;
  if (sensors.camera == nullptr)
    throw std::runtime_error("the recording has no images of a pair of cameras");
  auto state = std::make_shared<State>(
      State{std::move(sensors.camera),
            FrameScans(std::move(sensors.velodyne)),
            stereo::StereoOdometry(recording.calibration.stereo, parameters.stereo),
            {},
            {}});
  return [state, visual, range = parameters.frames, every = parameters.every](LidarFrame* frame) {
    StereoPair& pair = state->pair;
    do {
      if (!state->camera->next(pair)) return false;
    } while (pair.sequence < range.first);
    if (pair.sequence > range.last) return false;
    if (!state->first) state->first = pair.sequence;
    frame->number = pair.sequence;
    if (visual) {
      frame->visual = state->stereo.process(pair);
    } else {
      static_cast<Sample&>(frame->visual.emplace()) = pair;
      frame->visual->status = OdometryStatus::too_few_features;
    }
    const bool used = (frame->number - *state->first) % every == 0;
    frame->scan = used ? state->scans.of(pair.stamp) : nullptr;
    return true;
  };
}

LidarFrames scan_frames(const std::shared_ptr<sensors::Source<LidarScan>>& scans,
                        const LidarRunParameters& parameters) {
  if (scans == nullptr) throw std::runtime_error("the recording has no scans of a LiDAR");
  return [scans, range = parameters.frames, every = parameters.every,
          scan = std::make_shared<LidarScan>()](LidarFrame* frame) {
    do {
      if (!scans->next(*scan)) return false;
    } while (scan->sequence < range.first || (scan->sequence - range.first) % every != 0);
    *frame = {scan->sequence, scan.get(), {}};
    return scan->sequence <= range.last;
  };
}

LidarRun::LidarRun(LidarFrames frames, const Eigen::Isometry3d& T_body_velo,
                   const LidarRunParameters& parameters)
    : frames_(std::move(frames)),
      odometer_(lidar::LidarOdometry(T_body_velo, seeded(parameters), nullptr,
                                     registration_of(parameters.method, seeded(parameters))),
                lidar::DisparityCorrection(seeded(parameters))) {}

std::optional<LidarStep> LidarRun::next() {
  if (!frames_(&frame_)) return std::nullopt;
  LidarStep step;
  step.frame = frame_.number;
  step.with_scan = frame_.scan != nullptr;
  const double begin = processor_milliseconds();
  const lidar::OdometerResult result =
      odometer_.process(lidar::view_of(frame_.scan), frame_.visual ? &*frame_.visual : nullptr);
  step.milliseconds = processor_milliseconds() - begin;
  step.lidar = result.lidar;
  step.odometry = result.odometry;
  step.pose = odometer_.odometry().pose();
  return step;
}

}  // namespace maploop::odometry
