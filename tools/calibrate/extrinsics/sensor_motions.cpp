#include "tools/calibrate/extrinsics/sensor_motions.h"

#include <algorithm>

#include "estimators/lidar/scan_preparation.h"
#include "estimators/lidar/visual_lidar_odometer.h"
#include "estimators/stereo/stereo_odometry.h"
#include "sensors/imu/aligned_imu.h"
#include "tools/calibrate/extrinsics/depth_edges.h"
#include "tools/calibrate/extrinsics/image_edges.h"

namespace maploop::extrinsics {
namespace {

// Adds a motion of the body that the estimator made with this mounting.
void add(const RelativeMotion& m, const Eigen::Isometry3d& T_body_sensor, SensorMotions& to) {
  ++to.samples;
  if (m.status != OdometryStatus::ok) return;
  to.motions.push_back({m.from, m.stamp, T_body_sensor.inverse() * m.T_from_to() * T_body_sensor});
}

// Calls use(sample) for each sample of the stretch, without reading pixels and points before it.
template <class T, class Use>
void each_sample(const std::unique_ptr<sensors::Source<T>>& source, const Stretch& stretch,
                 const Progress& progress, const Use& use) {
  T sample;
  while (source->next(sample) && sample.stamp <= stretch.to) {
    if (!stretch.contains(sample.stamp)) continue;
    if (progress) progress(sample.stamp);
    use(sample);
  }
}

// The moments of which is kept what sensors saw: the first samples after equal steps of time.
class Moments {
 public:
  explicit Moments(const vehicle::Recording& recording, const Stretch& stretch)
      : next_(std::max(recording.first_stamp, stretch.from)),
        step_(std::max(from_seconds(0.5),
                       (std::min(recording.last_stamp, stretch.to) - next_) / most)) {}

  bool due(Time stamp) {
    if (stamp < next_) return false;
    while (next_ <= stamp) next_ += step_;
    return true;
  }

 private:
  static constexpr int most = 240;
  Time next_;
  Duration step_;
};

// Surfaces close by, finer than those of odometry.
lidar::LidarParameters surface_parameters(lidar::LidarParameters parameters) {
  parameters.max_range = std::min(parameters.max_range, 40.0);
  parameters.sample_voxel = 0.5;
  return parameters;
}

}  // namespace

CameraMotions camera_motions(const vehicle::Recording& recording,
                             const vehicle::VehicleConfig& config, const Stretch& stretch,
                             const Progress& progress) {
  CameraMotions result;
  result.calibration = recording.calibration.stereo;
  const auto camera = recording.sensors(stretch.from).camera;
  if (camera == nullptr) return result;
  const CameraDescription& described = config.vehicle.camera;
  const Eigen::Isometry3d T_body_camera = camera_pose(described.position, described.rotation);
  stereo::StereoOdometry odometry(recording.calibration.stereo, config.stereo);
  Moments moments(recording, stretch);
  each_sample(camera, stretch, progress, [&](const StereoPair& pair) {
    add(odometry.process(pair), T_body_camera, result);
    if (!moments.due(pair.stamp)) return;
    CameraView& view = result.views.emplace_back();
    view.stamp = pair.stamp;
    for (const stereo::StereoTrack& track : odometry.tracks())
      view.points.push_back(stereo::image_of(track.current));
    view.edges = vertical_edges(pair.left);
  });
  return result;
}

LidarMotions lidar_motions(const vehicle::Recording& recording,
                           const vehicle::VehicleConfig& config, const Stretch& stretch,
                           const Progress& progress) {
  LidarMotions result;
  const auto scans = recording.sensors(stretch.from).velodyne;
  if (scans == nullptr) return result;
  const LidarDescription& described = config.vehicle.lidar;
  const Eigen::Isometry3d T_body_lidar = sensor_pose(described.position, described.rotation);
  lidar::VisualLidarOdometer odometer(recording.calibration.T_body_velo, config.lidar);
  lidar::ScanPreparation preparation(Eigen::Isometry3d::Identity(),
                                     surface_parameters(config.lidar));
  Moments moments(recording, stretch);
  each_sample(scans, stretch, progress, [&](const LidarScan& scan) {
    const std::size_t before = result.motions.size();
    add(odometer.process(&scan, nullptr).lidar, T_body_lidar, result);
    if (result.motions.size() == before || !moments.due(scan.stamp)) return;
    const SensorMotion& m = result.motions.back();
    const auto twist = lidar::Twist::of(m.T_from_to, to_seconds(m.to - m.from));
    LidarView& view = result.views.emplace_back();
    preparation.prepare(scan, scan.stamp, twist, &view.surfaces);
    view.edges = depth_edges(scan, twist, config.lidar.elevation_correction);
  });
  return result;
}

InertialRates inertial_rates(const vehicle::Recording& recording, const Stretch& stretch) {
  InertialRates result;
  const auto imu = recording.sensors(Time::max()).imu;
  if (imu == nullptr) return result;
  result.vertical_alone = true;
  ImuSample sample;
  while (imu->next(sample)) {
    if (!stretch.contains(sample.stamp)) continue;
    result.samples.push_back(
        {sample.stamp, {sample.roll_rate, sample.pitch_rate, sample.yaw_rate}});
    if (sample.six_axes) result.vertical_alone = false;
  }
  if (const auto* unit = dynamic_cast<const sensors::AlignedImu*>(imu.get()))
    result.mount = unit->alignment().mount();
  return result;
}

}  // namespace maploop::extrinsics
