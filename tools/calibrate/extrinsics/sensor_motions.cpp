#include "tools/calibrate/extrinsics/sensor_motions.h"

#include "estimators/lidar/visual_lidar_odometer.h"
#include "estimators/stereo/stereo_odometry.h"
#include "sensors/imu/aligned_imu.h"

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

}  // namespace

SensorMotions camera_motions(const vehicle::Recording& recording,
                             const vehicle::VehicleConfig& config, const Stretch& stretch,
                             const Progress& progress) {
  SensorMotions result;
  const auto camera = recording.sensors(stretch.from).camera;
  if (camera == nullptr) return result;
  const CameraDescription& described = config.vehicle.camera;
  const Eigen::Isometry3d T_body_camera = camera_pose(described.position, described.rotation);
  stereo::StereoOdometry odometry(recording.calibration.stereo, config.stereo);
  each_sample(camera, stretch, progress,
              [&](const StereoPair& pair) { add(odometry.process(pair), T_body_camera, result); });
  return result;
}

SensorMotions lidar_motions(const vehicle::Recording& recording,
                            const vehicle::VehicleConfig& config, const Stretch& stretch,
                            const Progress& progress) {
  SensorMotions result;
  const auto scans = recording.sensors(stretch.from).velodyne;
  if (scans == nullptr) return result;
  const LidarDescription& described = config.vehicle.lidar;
  const Eigen::Isometry3d T_body_lidar = sensor_pose(described.position, described.rotation);
  lidar::VisualLidarOdometer odometer(recording.calibration.T_body_velo, config.lidar);
  each_sample(scans, stretch, progress, [&](const LidarScan& scan) {
    add(odometer.process(&scan, nullptr).lidar, T_body_lidar, result);
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
