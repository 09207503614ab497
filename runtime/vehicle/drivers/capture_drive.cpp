#include "runtime/vehicle/drivers/capture_drive.h"

#include <memory>
#include <stdexcept>

#include "sensors/velodyne/capture_source.h"

namespace maploop::vehicle {

bool is_capture(const std::filesystem::path& path) {
  std::filesystem::path name = path.filename();
  if (name.extension() == ".gz") name.replace_extension();
  return name.extension() == ".pcap" || name.extension() == ".pcapng";
}

Recording open_capture(const std::filesystem::path& path, const VehicleConfig& config) {
  const auto open = [path, calibration = config.vehicle.lidar.calibration] {
    return std::make_unique<sensors::VelodyneCapture>(
        path, sensors::VelodyneCaptureOptions{{}, calibration});
  };
  Recording recording;
  recording.calibration = live_calibration(config);
  recording.delays = delays_of(config);
  const auto capture = open();
  for (LidarScan scan; capture->next(scan); ++recording.images) {
    if (recording.images == 0) recording.first_stamp = scan.stamp;
    recording.last_stamp = scan.stamp;
  }
  if (recording.images == 0) {
    throw std::runtime_error("the capture '" + path.string() +
                             "' has no complete scanner revolution to replay");
  }
  recording.sensors = [open](Time) {
    Sensors s;
    s.velodyne = open();
    return s;
  };
  return recording;
}

}  // namespace maploop::vehicle
