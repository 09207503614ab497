#include "runtime/vehicle/drivers/folder_recording.h"

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "runtime/vehicle/drivers/gnss_drive.h"
#include "runtime/vehicle/drivers/table_drive.h"
#include "sensors/cloud/scan_folder.h"
#include "sensors/folder/euroc.h"
#include "sensors/folder/image_lists.h"
#include "sensors/folder/kitti_360.h"
#include "sensors/folder/sequence_calibration.h"
#include "sensors/replay/kitti_drive.h"

namespace maploop::vehicle {
namespace {

namespace fs = std::filesystem;

bool is_plain(const fs::path& folder) {
  return sensors::has_images(folder) || sensors::ScanFolder::is(folder) ||
         (sensors::find_scans(folder) && !fs::exists(folder / "image_00"));
}

// Leaves out images without a calibration, if something else is there.
void require_calibration(sensors::DriveParts& parts, const VehicleConfig& config) {
  if (!parts.images || described(config, parts.calibration).stereo.width > 0) return;
  const std::string what =
      "the images of '" + parts.folder.string() +
      "' have no calibration: [vehicle.camera] calibration of the configuration names that of raw "
      "cameras, and width, height, fx, fy, cx, cy and baseline describe rectified ones";
  if (parts.clouds.empty()) throw std::runtime_error(what);
  parts.images.reset();
  parts.notes.push_back("Not used are " + what + ".");
}

// Opens a folder of lists of images, clouds and tables.
sensors::DriveParts open_plain(const fs::path& folder, const VehicleConfig& config) {
  sensors::DriveParts parts;
  parts.folder = fs::absolute(folder).lexically_normal();
  parts.images = sensors::find_images(folder, from_seconds(config.replay.max_pair_skew));
  parts.clouds =
      sensors::ScanFolder::is(folder) ? folder : sensors::find_scans(folder).value_or(fs::path());
  parts.raw_cameras = raw_cameras(config);
  parts.calibration.stereo.T_body_cam = camera_pose({}, {});
  std::error_code ignored;
  if (parts.raw_cameras) {
    parts.calibration.stereo = sensors::mounted(
        *parts.raw_cameras, parts.raw_cameras->T_body_left.value_or(camera_pose({}, {})));
  } else if (parts.images && fs::exists(folder / "calib.txt", ignored)) {
    parts.calibration =
        sensors::read_sequence_calibration(folder / "calib.txt", parts.images->left);
  }
  require_calibration(parts, config);
  if (!parts.clouds.empty()) {
    const std::string assumed = sensors::ScanFolder(parts.clouds).assumption();
    if (!assumed.empty()) parts.notes.push_back(assumed);
  }
  if (const auto mapping = find_table_mapping(folder))
    parts.tables = std::make_shared<const sensors::TableRecording>(*mapping);
  return parts;
}

std::shared_ptr<sensors::FolderDrive> open_layout(const fs::path& folder,
                                                  const VehicleConfig& config) {
  const auto of = [&](sensors::DriveParts parts) {
    return std::make_shared<sensors::FolderDrive>(std::move(parts), config.replay);
  };
  if (const auto mav0 = sensors::find_euroc(folder)) {
    return of(
        sensors::open_euroc(*mav0, from_seconds(config.replay.max_pair_skew), raw_cameras(config)));
  }
  if (const auto name = sensors::find_kitti_360(folder)) return of(sensors::open_kitti_360(*name));
  if (is_plain(folder)) return of(open_plain(folder, config));
  return std::make_shared<sensors::KittiDrive>(folder, config.replay, raw_cameras(config));
}

// Returns a receiver's observations beside the drive's other sensors; nullptr if there are none.
std::shared_ptr<const GnssDrive> observations_of(const sensors::FolderDrive& drive,
                                                 const VehicleConfig& config) {
  const fs::path gnss = drive.folder() / "gnss";
  if (!config.ppp.observations || !is_gnss_drive(gnss)) return nullptr;
  return std::make_shared<const GnssDrive>(gnss, config);
}

void use_oxts(Sensors& s, const sensors::FolderDrive& drive, const VehicleConfig& config) {
  s.imu = drive.imu();
  s.gnss = drive.gnss(config.gnss);
  if (config.fusion.use_wheel_speed) s.wheel = drive.wheel(config.wheel);
  s.reference = drive.reference();
}

void use_tables(Sensors& s, const sensors::FolderDrive& drive, const VehicleConfig& car,
                const SensorDelays& delays, const std::vector<GnssOutage>& outages) {
  const sensors::TableRecording& tables = *drive.tables();
  s.gnss = tables.gnss();
  const sensors::MountParameters given = mount_of(car);
  if (tables.has_imu()) {
    s.imu = tables.imu(on_the_units_clock(tables.gnss(), outages, delays),
                       given.given ? given : drive.mount(), car.fusion.rear_axle_distance);
  }
  s.wheel = tables.wheel();
  s.reference = tables.reference();
}

bool has_oxts_alone(const fs::path& folder) {
  std::error_code ignored;
  if (fs::is_directory(folder / "oxts", ignored)) {
    const auto has = [&](const char* sensor) {
      return fs::is_directory(folder / sensor, ignored) ||
             fs::is_directory(sensors::kitti_image_folder(folder) / sensor, ignored);
    };
    return !has("image_00") && !has("velodyne_points");
  }
  if (!fs::is_directory(folder, ignored)) return false;
  const auto name = sensors::find_kitti_360(folder);
  return name && !fs::is_directory(name->root / "data_2d_raw" / name->drive, ignored) &&
         !fs::is_directory(name->root / "data_3d_raw" / name->drive, ignored);
}

}  // namespace

std::optional<FusedSensors> fused_sensors_of_folder(const fs::path& folder) {
  if (has_oxts_alone(folder)) return FusedSensors{false, true, true, false};
  if (is_plain(folder) && find_table_mapping(folder)) return FusedSensors{true, true};
  return std::nullopt;
}

Recording open_folder(const fs::path& folder, const VehicleConfig& config) {
  const auto drive = open_layout(folder, config);
  drive->set_calibration(described(config, drive->calibration()));
  const auto epochs = observations_of(*drive, config);
  Recording recording;
  recording.calibration = drive->calibration();
  if (const auto fused = fused_sensors_of_folder(folder)) recording.calibration.fused = *fused;
  recording.first_stamp = drive->first_stamp();
  recording.last_stamp = drive->last_stamp();
  recording.images = drive->frame_count();
  recording.wheels_are_made = drive->has_oxts() && drive->tables() == nullptr;
  recording.notes = drive->notes();
  recording.delays = drive->has_oxts() ? delays_of_oxts(config) : delays_of(config);
  VehicleConfig car = config;
  if (drive->tables() != nullptr) describe_car(car, recording.calibration);
  recording.sensors = [drive, epochs, car, delays = recording.delays,
                       outages = outages_of(config, recording)](Time passed) {
    Sensors s;
    if (drive->has_images()) s.camera = drive->camera(passed);
    if (drive->has_velodyne()) s.velodyne = drive->velodyne(passed);
    if (drive->has_oxts()) use_oxts(s, *drive, car);
    if (drive->tables() != nullptr) use_tables(s, *drive, car, delays, outages);
    if (epochs != nullptr) use_observations(s, epochs);
    return s;
  };
  std::error_code ignored;
  const auto labels = drive->folder().parent_path() / "driven_links.csv";
  if (drive->has_images() && fs::exists(labels, ignored))
    recording.driven_links = {labels, drive->image_stamps()};
  return recording;
}

}  // namespace maploop::vehicle
