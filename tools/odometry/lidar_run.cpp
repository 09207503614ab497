#include "tools/odometry/lidar_run.h"

#include "estimators/lidar/visual_lidar_odometer.h"
#include "estimators/stereo/stereo_odometry.h"
#include "tools/odometry/frame_scans.h"
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
        scans(drive),
        stereo(drive.calibration().stereo, p.stereo),
        odometer(drive.calibration().T_body_velo, seeded(p)) {}

  // Returns the visual motion of the pair; without a visual seed it only contains the stamp.
  VisualMotion visual() {
    if (parameters.seed == LidarSeed::vo) return stereo.process(pair);
    VisualMotion refused;
    static_cast<Sample&>(refused) = pair;
    refused.status = OdometryStatus::too_few_features;
    return refused;
  }

  // Returns the scan of this frame, or null if the drive does not have it or it is not used.
  const LidarScan* scan_of(std::size_t frame) {
    return (frame - first) % parameters.every == 0 ? scans.of(frame) : nullptr;
  }

  LidarRunParameters parameters;
  std::unique_ptr<sensors::Source<StereoPair>> camera;
  FrameScans scans;
  stereo::StereoOdometry stereo;
  lidar::VisualLidarOdometer odometer;
  StereoPair pair;
  const LidarScan* scan = nullptr;
  bool started = false;
  std::size_t first = 0;
};

LidarRun::LidarRun(const sensors::KittiDrive& drive, const LidarRunParameters& parameters)
    : state_(std::make_unique<State>(drive, parameters)) {}

LidarRun::~LidarRun() = default;

std::optional<LidarStep> LidarRun::next() {
  State& s = *state_;
  do
    if (!s.camera->next(s.pair)) return std::nullopt;
  while (s.pair.sequence < s.parameters.frames.first);
  if (s.pair.sequence > s.parameters.frames.last) return std::nullopt;
  if (!s.started) s.first = s.pair.sequence;
  s.started = true;

  const VisualMotion seen = s.visual();
  LidarStep step;
  step.frame = s.pair.sequence;
  s.scan = s.scan_of(step.frame);
  step.with_scan = s.scan != nullptr;
  const double begin = processor_milliseconds();
  const lidar::OdometerResult result = s.odometer.process(s.scan, &seen);
  step.milliseconds = processor_milliseconds() - begin;
  step.lidar = result.lidar;
  step.odometry = result.odometry;
  step.pose = s.odometer.odometry().pose();
  return step;
}

const LidarScan& LidarRun::scan() const {
  return *state_->scan;
}

}  // namespace maploop::odometry
