#include "tools/simulate/sensors/frame_writer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "sensors/image/png.h"
#include "sensors/replay/files.h"
#include "sensors/replay/packed_scan.h"
#include "tools/simulate/output_file.h"
#include "tools/simulate/random.h"
#include "tools/simulate/sensors/camera_image.h"
#include "tools/simulate/town/site.h"

namespace maploop::simulate {
namespace {

// An object belongs to one thread; any number of objects may share a drive.
class FrameWriter {
 public:
  FrameWriter(const Drive& drive, const std::filesystem::path& folder,
              const SimulationOptions& options)
      : drive_(drive),
        folder_(folder),
        options_(options),
        lidar_(lidar_parameters(options.scanner)),
        scene_(*drive.world) {
    lidar_.range_scale = drive.errors.range_scale;
    lidar_.unit = drive.errors.scanner_unit;
  }

  void write(std::size_t frame);

 private:
  void write_images(std::size_t frame, std::uint64_t seed);
  void write_turn(std::size_t frame, std::uint64_t seed);

  const Drive& drive_;
  const std::filesystem::path& folder_;
  const SimulationOptions& options_;
  LidarParameters lidar_;
  RayScene scene_;
};

void FrameWriter::write(std::size_t frame) {
  const std::uint64_t seed = mix(options_.seed, 1'000'000 + frame);
  if (options_.sensors.camera) write_images(frame, seed);
  if (options_.sensors.lidar) write_turn(frame, seed);
}

void FrameWriter::write_images(std::size_t frame, std::uint64_t seed) {
  const double t = drive_.times[frame];
  const StereoCalibration& camera = drive_.calibration.stereo;
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
    if (options_.compact)
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
        return drive_.motion.pose(begin + share * drive_.turn_time) *
               drive_.calibration.T_body_velo;
      },
      mix(seed, 2), lidar_);
  const std::filesystem::path data = folder_ / "velodyne_points/data";
  if (options_.compact) {
    write_file(data / sensors::numbered_file(frame, ".scan"), sensors::pack_scan(turn));
    return;
  }
  std::vector<LidarPoint> points;
  sensors::points_of(turn, points);
  write_file(data / sensors::numbered_file(frame, ".bin"),
             {reinterpret_cast<const char*>(points.data()), points.size() * sizeof(LidarPoint)});
}

}  // namespace

bool write_frames(const Drive& drive, const std::filesystem::path& folder,
                  const SimulationOptions& options, const FrameDone& frame_done) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // protects the variables below
  std::size_t done = 0;
  bool stop = false;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      FrameWriter writer(drive, folder, options);
      for (std::size_t frame; (frame = next++) < drive.times.size();) {
        writer.write(frame);
        const std::lock_guard lock(mutex);
        if (frame_done && !frame_done(++done, drive.times.size())) stop = true;
        if (stop) return;
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      failure = std::current_exception();
      stop = true;
    }
  };
  {
    std::vector<std::jthread> workers;
    const unsigned threads =
        options.threads > 0 ? options.threads : std::max(1U, std::thread::hardware_concurrency());
    for (unsigned i = 0; i < threads; ++i) workers.emplace_back(work);
  }
  if (failure) std::rethrow_exception(failure);
  return !stop;
}

}  // namespace maploop::simulate
