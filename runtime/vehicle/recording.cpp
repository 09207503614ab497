#include "runtime/vehicle/recording.h"

#include <memory>

#include "sensors/replay/kitti_drive.h"
#include "sensors/replay/log_recording.h"

namespace maploop::vehicle {
namespace {

template <class Opened>
Recording describe(const Opened& opened, std::function<Sensors(Time)> sensors) {
  return {opened.calibration(), opened.first_stamp(), opened.last_stamp(), opened.frame_count(),
          std::move(sensors)};
}

Recording open_drive(const std::filesystem::path& folder, const VehicleConfig& config) {
  auto drive = std::make_shared<const sensors::KittiDrive>(folder, config.replay);
  return describe(*drive, [drive, gnss = config.gnss](Time passed) {
    Sensors s;
    s.camera = drive->camera(passed);
    if (drive->has_velodyne()) s.velodyne = drive->velodyne(passed);
    if (drive->has_oxts()) {
      s.imu = drive->imu();
      s.gnss = drive->gnss(gnss);
      s.reference = drive->reference();
    }
    return s;
  });
}

Recording open_log(const std::filesystem::path& file) {
  auto log = std::make_shared<const sensors::LogRecording>(file);
  return describe(*log, [log](Time) {
    Sensors s;
    s.camera = log->camera();
    s.velodyne = log->velodyne();
    s.imu = log->imu();
    s.gnss = log->gnss();
    s.reference = log->reference();
    if (s.camera == nullptr) s.odometry = log->odometry();
    return s;
  });
}

}  // namespace

Recording open_recording(const std::filesystem::path& path, const VehicleConfig& config) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) ? open_log(path)
                                                         : open_drive(path, config);
}

}  // namespace maploop::vehicle
