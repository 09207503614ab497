#include "tools/simulate/sensors/frame_writer.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sensors/image/png.h"
#include "sensors/replay/files.h"
#include "sensors/replay/packed_scan.h"
#include "tools/simulate/output_file.h"
#include "tools/simulate/random.h"
#include "tools/simulate/sensors/camera_image.h"
#include "tools/simulate/town/traffic.h"

namespace maploop::simulate {
namespace {

LidarParameters lidar_of(Scanner scanner, const CalibrationErrors& errors) {
  LidarParameters parameters = lidar_parameters(scanner);
  parameters.range_scale = errors.range_scale;
  parameters.unit = errors.scanner_unit;
  return parameters;
}

}  // namespace

FrameWriter::FrameWriter(const Drive& drive, std::filesystem::path folder,
                         const SimulationOptions& options)
    : drive_(drive),
      folder_(std::move(folder)),
      seed_(options.seed),
      sensors_(options.sensors),
      lidar_(lidar_of(options.scanner, drive.errors)),
      compact_(options.compact),
      scene_(*drive.world) {}

void FrameWriter::write(std::size_t frame) {
  const std::uint64_t seed = mix(seed_, 1'000'000 + frame);
  if (sensors_.camera) write_images(frame, seed);
  if (sensors_.lidar) write_turn(frame, seed);
}

void FrameWriter::write_images(std::size_t frame, std::uint64_t seed) {
  const double t = drive_.times[frame];
  const StereoCalibration& camera = drive_.car.stereo;
  const CameraParameters parameters;
  const double half = 0.5 * parameters.exposure_time;
  scene_.move(
      bodies(drive_.traffic, t - 0.5 * Drive::frame_interval, t + 0.5 * Drive::frame_interval));
  // Brightness changes that an exposure control does not remove.
  const auto brightness = static_cast<float>(1.0 + 0.08 * std::sin(0.35 * t) * std::sin(0.9 * t));
  for (int side = 0; side < 2; ++side) {
    const Eigen::Isometry3d T_body_cam =
        camera.T_body_cam * Eigen::Translation3d(side * camera.baseline, 0.0, 0.0);
    const CameraView view{
        {drive_.motion.pose(t - half) * T_body_cam, drive_.motion.pose(t + half) * T_body_cam},
        side == 0 ? ColumnShift{} : -drive_.errors.disparity_lack};
    GreyImage image = take_image(scene_, drive_.appearance, camera, view, 0.5F, brightness,
                                 mix(seed, static_cast<std::uint64_t>(side)), parameters);
    if (compact_)
      for (auto& pixel : image.pixels) pixel = static_cast<std::uint8_t>((pixel + 1) / 3 * 3);
    const std::vector<std::uint8_t> png =
        sensors::encode_png(image.pixels, image.width, image.height, sensors::PngContent::noise);
    write_file(folder_ / (side == 0 ? "image_00" : "image_01") / "data" /
                   sensors::numbered_file(frame, ".png"),
               {reinterpret_cast<const char*>(png.data()), png.size()});
  }
}

void FrameWriter::write_turn(std::size_t frame, std::uint64_t seed) {
  const double begin = drive_.turns[frame];
  scene_.move(bodies(drive_.traffic, begin, begin + drive_.turn_time));
  const sensors::RangeImage turn = take_turn(
      scene_, drive_.appearance,
      [&](double share) {
        return drive_.motion.pose(begin + share * drive_.turn_time) * drive_.car.T_body_velo;
      },
      mix(seed, 2), lidar_);
  const std::filesystem::path data = folder_ / "velodyne_points/data";
  if (compact_) {
    write_file(data / sensors::numbered_file(frame, ".scan"), sensors::pack_scan(turn));
    return;
  }
  std::vector<LidarPoint> points;
  sensors::points_of(turn, points);
  write_file(data / sensors::numbered_file(frame, ".bin"),
             {reinterpret_cast<const char*>(points.data()), points.size() * sizeof(LidarPoint)});
}

}  // namespace maploop::simulate
