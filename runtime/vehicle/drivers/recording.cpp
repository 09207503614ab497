#include "runtime/vehicle/drivers/recording.h"

#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "estimators/fusion/configuration.h"
#include "msgs/lcm/channel_names.h"
#include "runtime/vehicle/drivers/bag_drive.h"
#include "runtime/vehicle/drivers/capture_drive.h"
#include "runtime/vehicle/drivers/folder_recording.h"
#include "runtime/vehicle/drivers/gnss_drive.h"
#include "runtime/vehicle/drivers/recorded_tracks.h"
#include "runtime/vehicle/drivers/stereo_rig_file.h"
#include "runtime/vehicle/drivers/table_drive.h"
#include "runtime/vehicle/drivers/track_odometry.h"
#include "runtime/vehicle/graph/graph.h"
#include "sensors/bag/message_reader.h"
#include "sensors/delayed.h"
#include "sensors/replay/imu_noise.h"
#include "sensors/replay/log_recording.h"
#include "sensors/replay/odometry_sequence.h"
#include "sensors/replay/pose_odometry.h"
#include "sensors/replay/sequence_files.h"

namespace maploop::vehicle {
namespace {

template <class Opened>
Recording make_recording(const Opened& opened, std::function<Sensors(Time)> sensors) {
  Recording recording;
  recording.calibration = opened.calibration();
  recording.first_stamp = opened.first_stamp();
  recording.last_stamp = opened.last_stamp();
  recording.images = opened.frame_count();
  recording.sensors = std::move(sensors);
  return recording;
}

// Returns the wheel odometer's parameters if the configuration uses a wheel speed.
std::optional<sensors::WheelOdometerParameters> wheel_of(const VehicleConfig& config) {
  return config.fusion.use_wheel_speed ? std::optional(config.wheel) : std::nullopt;
}

Recording open_sequence(const std::filesystem::path& path, const VehicleConfig& config) {
  auto sequence = std::make_shared<const sensors::OdometrySequence>(path, config.replay);
  std::shared_ptr<const RecordedTracks> tracks;
  std::shared_ptr<const sensors::CameraPoses> poses;
  if (!config.odometry_poses.file.empty()) {
    poses = std::make_shared<const sensors::CameraPoses>(
        sensors::read_camera_poses(config.odometry_poses.file));
  } else if (sequence->tracks_file()) {
    tracks = std::make_shared<const RecordedTracks>(read_recorded_tracks(*sequence->tracks_file()));
  }
  const Eigen::Isometry3d T_body_cam = described(config, sequence->calibration()).stereo.T_body_cam;
  Recording recording = make_recording(*sequence, [=](Time) {
    Sensors s;
    s.imu = sequence->imu();
    s.gnss = sequence->gnss(config.gnss);
    if (const auto wheel = wheel_of(config)) s.wheel = sequence->wheel(*wheel);
    s.reference = sequence->reference();
    if (tracks != nullptr || poses != nullptr) {
      const Duration delay = from_seconds(config.replay.camera_readout) + stages::stereo.budget;
      const auto odometry = [&] {
        if (poses != nullptr) {
          return sensors::make_pose_odometry(poses, sequence->image_stamps(), T_body_cam,
                                             config.odometry_poses, delay);
        }
        return make_track_odometry(tracks, sequence->image_stamps(),
                                   for_recorded_tracks(config.stereo), delay);
      };
      s.odometry = odometry();
      s.visual = odometry();
    }
    return s;
  });
  recording.delays = delays_of_oxts(config);
  if (const auto& labels = sequence->labels_file())
    recording.driven_links = {*labels, sequence->image_stamps()};
  if (tracks != nullptr) recording.calibration.stereo = tracks->calibration;
  recording.wheels_are_made = true;
  return recording;
}

// Its stamps are without delays: they are those that the recording vehicle used.
Recording open_log(const std::filesystem::path& file) {
  auto log = std::make_shared<const sensors::LogRecording>(file);
  return make_recording(*log, [log](Time) {
    const auto open = [&]<class T>(std::unique_ptr<sensors::Source<T>>& to, std::string_view name) {
      to = log->source<T>(name);
    };
    Sensors s;
    open(s.camera, channel_names::camera);
    open(s.velodyne, channel_names::velodyne);
    open(s.imu, channel_names::imu);
    open(s.gnss, channel_names::gnss_fix);
    open(s.wheel, channel_names::wheel_speed);
    open(s.reference, channel_names::truth);
    if (s.camera == nullptr) {
      open(s.odometry, channel_names::odometry);  // as fusion received it
      open(s.visual, channel_names::visual_odometry);
      open(s.lidar, channel_names::lidar_odometry);
    }
    return s;
  });
}

// The epochs take the place of the images.
Recording open_gnss(const std::filesystem::path& path, const VehicleConfig& config) {
  auto drive = std::make_shared<const GnssDrive>(path, config);
  Recording recording;
  recording.first_stamp = drive->first_stamp();
  recording.last_stamp = drive->last_stamp();
  recording.images = drive->setup().observations().epochs.size();
  recording.sensors = [drive](Time) {
    Sensors s;
    use_observations(s, drive);
    return s;
  };
  return recording;
}

// Any file that is nothing else.
bool is_log(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) && !is_capture(path) &&
         !is_gnss_drive(path) && !sensors::OdometrySequence::is_named(path);
}

Recording open_any(const std::filesystem::path& path, const VehicleConfig& config,
                   const KnownContents& contents) {
  if (sensors::OdometrySequence::is_named(path)) return open_sequence(path, config);
  if (!config.odometry_poses.file.empty()) {
    throw std::runtime_error(
        "poses in place of visual odometry can only be used with a table of OXTS " +
        std::string("rows (such as oxts/06.csv), not with '") + path.string() + "'");
  }
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    throw std::runtime_error("there is no file or folder '" + path.string() +
                             "'; 'maploop replay --help' lists what can be replayed");
  }
  if (sensors::is_bag(path)) return open_bag(path, config, contents);
  if (is_capture(path)) return open_capture(path, config);
  if (is_table_drive(path)) return open_tables(path, config);
  if (is_gnss_drive(path)) return open_gnss(path, config);
  return std::filesystem::is_regular_file(path, ignored) ? open_log(path)
                                                         : open_folder(path, config);
}

std::optional<sensors::ImuNoiseParameters> noise_of(const VehicleConfig& config) {
  if (config.imu_noise == "recorded") return std::nullopt;
  if (config.imu_noise == "mems") {
    const auto noise = sensors::mems_noise(config.imu_seed);
    return config.imu_errors == sensors::ErrorModel::drawn ? sensors::drawn(noise) : noise;
  }
  throw std::runtime_error("'" + config.imu_noise +
                           "' is not a known inertial noise; use recorded or mems");
}

}  // namespace

std::vector<GnssOutage> outages_of(const VehicleConfig& config, const Recording& recording) {
  if (config.gnss_outage.empty()) return {};
  if (!config.fusion.use_gnss) {
    throw std::runtime_error("a GNSS outage needs a configuration that uses GNSS: GNSS+" +
                             config.configuration + " instead of " + config.configuration);
  }
  return parse_outages(config.gnss_outage, recording.first_stamp, recording.last_stamp,
                       config.gnss.seed);
}

std::optional<sensors::StereoRig> raw_cameras(const VehicleConfig& config) {
  const CameraDescription& camera = config.vehicle.camera;
  if (camera.calibration.empty()) return std::nullopt;
  sensors::StereoRig rig = read_stereo_rig(camera.calibration);
  if (has_pose(config, "vehicle.camera")) {
    rig.T_body_left =
        camera_pose(camera.position, camera.rotation) * Eigen::Isometry3d(rig.R_rect_left);
  }
  return rig;
}

sensors::MountParameters mount_of(const VehicleConfig& config) {
  const SensorRotation& r = config.vehicle.imu.rotation;
  return {has_pose(config, "vehicle.imu"), r.roll, -r.pitch, r.yaw};
}

Recording open_recording(const std::filesystem::path& path, const VehicleConfig& config,
                         const KnownContents& contents) {
  Recording recording = open_any(path, config, contents);
  recording.calibration = described(config, recording.calibration);
  recording.outages = outages_of(config, recording);
  recording.sensors = [plain = std::move(recording.sensors), outages = recording.outages,
                       delays = recording.delays, noise = noise_of(config)](Time passed) {
    Sensors s = plain(passed);
    take_delays(s, delays);
    s.gnss = with_outages(std::move(s.gnss), outages);
    s.epochs = with_outages(std::move(s.epochs), outages);
    if (noise && s.imu != nullptr) s.imu = sensors::with_noise(std::move(s.imu), *noise);
    return s;
  };
  const Duration camera = recording.delays.camera, antenna = recording.delays.antenna;
  if (recording.driven_links)
    for (Time& stamp : recording.driven_links->stamps) stamp -= camera;
  if (recording.fixes) {
    recording.fixes = [recorded = std::move(recording.fixes), antenna] {
      return sensors::delayed(recorded(), antenna);
    };
  }
  return recording;
}

KnownContents fit_to_recording(VehicleConfig& config, const std::filesystem::path& path) {
  std::optional<FusedSensors> there;
  KnownContents contents;
  const bool is_bag = sensors::is_bag(path);
  if (!is_bag && !config.bag.topics.empty() && !config.is_given("bag", "topics")) {
    throw std::runtime_error("--topic names topics of a recording of ROS, and '" + path.string() +
                             "' is none");
  }
  if (is_bag) {
    contents = std::make_shared<const sensors::BagSummary>(sensors::summarize(path));
    there = fused_sensors_of_bag(path, *contents, config.bag);
  } else if (is_table_drive(path)) {
    there = fused_sensors_of(*find_table_mapping(path));
  } else if (is_log(path)) {
    there = sensors::LogRecording::fused_sensors_of(path);
  } else {
    there = fused_sensors_of_folder(path);
  }
  if (!there) return contents;
  if (!there->motion && !config.is_given("", "configuration")) {
    set_configuration(config, !there->inertial ? "GNSS" : there->wheels ? "GNSS+RISS" : "GNSS+RI");
  }
  if (there->mems && !config.is_given("", "imu_grade")) set_imu_grade(config, "mems");
  return contents;
}

fusion::KnownStart start_from_reference(const Recording& recording) {
  const auto reference = recording.sensors(Time::max()).reference;
  ReferencePose pose, next;
  if (reference == nullptr || !reference->next(pose) || !reference->next(next)) {
    throw std::runtime_error("the recording has no reference trajectory to start from");
  }
  // Velocities are older than the poses of their rows: this one is carried linearly to the pose's
  // stamp.
  const double share = to_seconds(pose.stamp - pose.velocity_stamp) /
                       to_seconds(next.velocity_stamp - pose.velocity_stamp);
  fusion::KnownStart known;
  known.stamp = pose.stamp;
  known.position = pose.position;
  known.attitude = pose.attitude;
  known.speed = (pose.velocity_enu + share * (next.velocity_enu - pose.velocity_enu)).norm();
  return known;
}

}  // namespace maploop::vehicle
