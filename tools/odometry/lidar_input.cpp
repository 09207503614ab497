#include "tools/odometry/lidar_input.h"

#include <stdexcept>

namespace maploop::odometry {

LidarInput::LidarInput(const InputFiles& files, const std::filesystem::path& stamps,
                       const LidarUse& use) {
  using enum LidarSeed;
  const std::string input = "'" + files.input.string() + "'";
  vehicle::VehicleConfig config;
  if (std::filesystem::is_directory(files.input / "image_00") ||
      !sensors::ScanFolder::is(files.input)) {
    config = open_recording(files, &recording_);
    T_body_velo = T_body_cam = recording_.calibration.T_body_velo;
    const vehicle::Sensors sensors = recording_.sensors(Time::max());
    if (sensors.velodyne == nullptr) throw std::runtime_error(input + " has no scans of a LiDAR");
    images_ = sensors.camera != nullptr;
    if (images_) T_body_cam = recording_.calibration.stereo.T_body_cam;
    if (!stamps.empty())
      throw std::runtime_error(input + " has the stamps of its scans: leave --stamps out");
  } else {
    config = vehicle::load_vehicle_config(files.config);
    folder_ = files.input;
    stamps_ = stamps;
  }
  if (!images_ && use.seed == vo) throw std::runtime_error(input + " has no images for --seed vo");
  parameters = {config.stereo, config.lidar, use.seed.value_or(images_ ? vo : motion), use.every,
                use.frames};
}

LidarRun LidarInput::run(Method method) {
  parameters.method = method;
  if (images_) return {drive_frames(recording_, parameters), T_body_velo, parameters};
  if (folder_.empty()) {
    return {scan_frames(recording_.sensors(Time::min()).velodyne, parameters), T_body_velo,
            parameters};
  }
  scans_ = std::make_shared<sensors::ScanFolder>(folder_, stamps_);
  return {scan_frames(scans_, parameters), T_body_velo, parameters};
}

}  // namespace maploop::odometry
