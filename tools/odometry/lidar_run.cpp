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

LidarFrames scan_frames(std::shared_ptr<sensors::Source<LidarScan>> scans,
                        const LidarRunParameters& parameters) {
  if (scans == nullptr) throw std::runtime_error("the recording has no scans of a LiDAR");
  return [scans, range = parameters.frames, every = parameters.every,
          scan = std::make_shared<LidarScan>()](LidarFrame* frame) {
    do {
      if (!scans->next(*scan)) return false;
    } while (scan->sequence < range.first || (scan->sequence - range.first) % every != 0);
    *frame = {scan->sequence, scan.get(), {}, {}};
    return scan->sequence <= range.last;
  };
}

LidarFrames folder_frames(std::shared_ptr<sensors::ScanFolder> folder,
                          const LidarRunParameters& parameters) {
  return [folder, frames = scan_frames(folder, parameters)](LidarFrame* frame) {
    const bool more = frames(frame);
    frame->times = folder->times();
    return more;
  };
}

LidarRun::LidarRun(LidarFrames frames, const Eigen::Isometry3d& T_body_velo,
                   const LidarRunParameters& parameters)
    : frames_(std::move(frames)),
      T_body_velo_(T_body_velo),
      method_(parameters.method),
      parameters_(seeded(parameters)),
      odometer_(new_odometer()) {}

lidar::VisualLidarOdometer LidarRun::new_odometer() const {
  return {lidar::LidarOdometry(T_body_velo_, parameters_, nullptr,
                               registration_of(method_, parameters_)),
          lidar::DisparityCorrection(parameters_)};
}

std::optional<LidarStep> LidarRun::next() {
  if (!frames_(&frame_)) return std::nullopt;
  LidarStep step;
  step.frame = frame_.number;
  step.with_scan = frame_.scan != nullptr;
  const double begin = processor_milliseconds();
  const lidar::OdometerResult result =
      frame_.times.empty()
          ? odometer_.process(frame_.scan, frame_.visual ? &*frame_.visual : nullptr)
          : process_timed();
  step.milliseconds = processor_milliseconds() - begin;
  step.lidar = result.lidar;
  step.odometry = result.odometry;
  step.pose = odometer_.odometry().pose();
  return step;
}

// The motion is known only after two scans; then both are processed again with it.
lidar::OdometerResult LidarRun::process_timed() {
  TimedScan now{*frame_.scan, {frame_.times.begin(), frame_.times.end()}};
  const bool known = twist_.has_value();
  lidar::OdometerResult result = process(now);
  if (!known && twist_) {
    odometer_ = new_odometer();
    process(before_);
    result = process(now);
  }
  if (!twist_) before_ = std::move(now);
  return result;
}

// Moves the points to the scan's stamp by the last motion to second order, as ScanPreparation does
// with times derived from azimuths.
lidar::OdometerResult LidarRun::process(const TimedScan& timed) {
  const lidar::Twist motion = twist_.value_or(lidar::Twist{});
  const Eigen::Vector3f v = motion.velocity.cast<float>(), w = motion.rate.cast<float>();
  deskewed_ = timed.scan;
  for (std::size_t i = 0; i < deskewed_.points.size(); ++i) {
    LidarPoint& p = deskewed_.points[i];
    const float t = timed.times[i];
    const Eigen::Vector3f x(p.x, p.y, p.z);
    const Eigen::Vector3f moved = x + t * (v + w.cross(x + (0.5F * t) * (w.cross(x) + v)));
    p = {moved.x(), moved.y(), moved.z(), p.reflectance};
  }
  const lidar::OdometerResult result = odometer_.process(&deskewed_, nullptr);
  const LidarMotion& m = result.lidar;
  if (m.status == OdometryStatus::ok)
    twist_ = lidar::Twist::of(m.T_from_to(), to_seconds(m.stamp - m.from));
  return result;
}

}  // namespace maploop::odometry
