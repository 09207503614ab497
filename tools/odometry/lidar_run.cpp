#include "tools/odometry/lidar_run.h"

#include <stdexcept>

#include "estimators/stereo/stereo_odometry.h"
#include "tools/odometry/processor_time.h"

namespace maploop::odometry {
namespace {

lidar::LidarParameters seeded(const LidarRunParameters& parameters) {
  lidar::LidarParameters p = parameters.lidar;
  p.constant_motion = p.constant_motion && parameters.seed != LidarSeed::none;
  return p;
}

}  // namespace

struct LidarRun::State {
  State(const sensors::KittiDrive& drive, const LidarRunParameters& p)
      : parameters(p),
        camera(drive.camera(p.seed == LidarSeed::vo ? Time::min() : Time::max())),
        velodyne(drive.velodyne()),
        stereo(drive.calibration().stereo, p.stereo),
        lidar(drive.calibration().T_body_velo, seeded(p)) {}

  // Of the pair; without a visual seed it says the moment alone.
  RelativeMotion visual() {
    if (parameters.seed == LidarSeed::vo) return stereo.process(pair);
    RelativeMotion refused;
    static_cast<Sample&>(refused) = pair;
    refused.status = OdometryStatus::too_few_features;
    return refused;
  }

  // The scan of this frame, where the drive has it and it is one of those that are used.
  bool has_scan(std::size_t frame) {
    if ((frame - first) % parameters.every != 0) return false;
    while (!scans_ended && (!scan_loaded || scan.sequence < frame)) {
      scan_loaded = velodyne->next(scan);
      scans_ended = !scan_loaded;
    }
    return scan_loaded && scan.sequence == frame;
  }

  LidarRunParameters parameters;
  std::unique_ptr<sensors::Source<StereoPair>> camera;
  std::unique_ptr<sensors::Source<LidarScan>> velodyne;
  stereo::StereoOdometry stereo;
  lidar::LidarOdometry lidar;
  StereoPair pair;
  LidarScan scan;
  bool scan_loaded = false;
  bool scans_ended = false;
  bool started = false;
  std::size_t first = 0;
};

LidarRun::LidarRun(const sensors::KittiDrive& drive, const LidarRunParameters& parameters) {
  if (!drive.has_velodyne())
    throw std::runtime_error(
        "the drive has no folder velodyne_points: there is nothing for LiDAR "
        "odometry; leave --lidar out");
  state_ = std::make_unique<State>(drive, parameters);
}

LidarRun::~LidarRun() = default;

std::optional<LidarStep> LidarRun::next() {
  State& s = *state_;
  do
    if (!s.camera->next(s.pair)) return std::nullopt;
  while (s.pair.sequence < s.parameters.frames.first);
  if (s.pair.sequence > s.parameters.frames.last) return std::nullopt;
  if (!s.started) s.first = s.pair.sequence;
  s.started = true;

  const RelativeMotion visual = s.visual();
  LidarStep step;
  step.frame = s.pair.sequence;
  step.with_scan = s.has_scan(step.frame);
  const double begin = processor_milliseconds();
  lidar::OdometerResult result = s.lidar.process(step.with_scan ? &s.scan : nullptr, &visual);
  step.milliseconds = processor_milliseconds() - begin;
  step.lidar = result.lidar;
  step.odometry = result.odometry;
  step.pose = s.lidar.pose();
  return step;
}

const LidarScan& LidarRun::scan() const {
  return state_->scan;
}

}  // namespace maploop::odometry
