#include "tools/simulate/simulation.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "msgs/frames.h"
#include "sensors/replay/files.h"
#include "tools/evaluation/trajectory_file.h"
#include "tools/simulate/camera_image.h"
#include "tools/simulate/lidar_turn.h"
#include "tools/simulate/output_file.h"
#include "tools/simulate/oxts_rows.h"
#include "tools/simulate/random.h"
#include "tools/simulate/road_map.h"
#include "tools/simulate/test_car.h"
#include "tools/simulate/town_scene.h"
#include "tools/simulate/traffic.h"

namespace maploop::simulate {
namespace {

constexpr double frame_interval = 0.1;  // s between frames; a turn of the scanner takes as long
constexpr double first_frame = 0.1;     // s, of the middle of the first turn
constexpr double fast_interval = 0.01;  // s between rows of the unsynced form
constexpr std::size_t car_count = 30;
constexpr float disparity_error = 0.2F;  // px too much, mean; as on KITTI's drive 0013

// Where and when: it matters to GNSS and to the sun of nobody.
const Geodetic town_origin{radians(49.01), radians(8.43), 115.0};
const Time drive_start = parse_time("2026-05-04 08:00:00.0");

// All that is fixed before the first frame is taken.
struct Drive {
  explicit Drive(const SimulationOptions& options)
      : streets(make_town(options.seed)),
        terrain(options.seed),
        index(streets, 2.5),
        appearance(index),
        car(test_car()),
        motion(make_motion(options)),
        traffic(make_traffic(streets, terrain, motion, car_count, options.seconds, options.seed)) {
    std::vector<Mesh> shapes;
    Random random(options.seed, 16);
    for (std::size_t i = 0; i < traffic.size(); ++i)
      shapes.push_back(make_car(static_cast<float>(random.uniform(0.05, 0.7)),
                                static_cast<std::uint32_t>(1000 + i)));
    world.emplace(make_town_scene(streets, index, terrain, options.seed), std::move(shapes));
    for (double t = first_frame; t + 0.5 * frame_interval <= options.seconds; t += frame_interval)
      times.push_back(t);
  }

  VehicleMotion make_motion(const SimulationOptions& options) const {
    // From the middle of the town, where there is something to see on all sides.
    const std::size_t begin = nearest_junction(streets, Eigen::Vector2d::Zero());
    const auto route = make_route(streets, begin, longest_drive(options.seconds), options.seed);
    auto path = std::make_shared<LanePath>(streets, route, options.seed);
    auto profile = std::make_shared<SpeedProfile>(*path, streets, options.seconds, options.seed);
    return {std::move(path), std::move(profile), terrain, options.seed};
  }

  Streets streets;
  Terrain terrain;
  StreetIndex index;
  Appearance appearance;
  VehicleCalibration car;
  VehicleMotion motion;
  std::vector<VehicleMotion> traffic;
  std::optional<World> world;
  std::vector<double> times;  // s, of the frames
};

class FrameWriter {
 public:
  FrameWriter(const Drive& drive, std::filesystem::path folder, std::uint64_t seed)
      : drive_(drive), folder_(std::move(folder)), seed_(seed), scene_(*drive.world) {}

  void write(std::size_t frame) {
    const double t = drive_.times[frame], begin = t - 0.5 * frame_interval;
    scene_.move(bodies(drive_.traffic, begin, begin + frame_interval));
    const std::uint64_t seed = mix(seed_, 1'000'000 + frame);
    const StereoCalibration& camera = drive_.car.stereo;
    const CameraParameters parameters;
    const double half = 0.5 * parameters.exposure_time;
    // What an exposure control leaves.
    const auto brightness = static_cast<float>(1.0 + 0.08 * std::sin(0.35 * t) * std::sin(0.9 * t));
    for (int side = 0; side < 2; ++side) {
      const Eigen::Isometry3d T_body_cam =
          camera.T_body_cam * Eigen::Translation3d(side * camera.baseline, 0.0, 0.0);
      const CameraView view{
          {drive_.motion.pose(t - half) * T_body_cam, drive_.motion.pose(t + half) * T_body_cam},
          side == 0 ? 0.0F : disparity_error};
      GreyImage image = take_image(scene_, drive_.appearance, camera, view, 0.5F, brightness,
                                   mix(seed, static_cast<std::uint64_t>(side)), parameters);
      std::vector<unsigned char> png;
      cv::imencode(".png", cv::Mat(image.height, image.width, CV_8U, image.pixels.data()), png,
                   {cv::IMWRITE_PNG_COMPRESSION, 1});
      write_file(folder_ / (side == 0 ? "image_00" : "image_01") / "data" /
                     sensors::numbered_file(frame, ".png"),
                 {reinterpret_cast<const char*>(png.data()), png.size()});
    }
    const auto points = take_turn(
        scene_, drive_.appearance,
        [&](double share) {
          return drive_.motion.pose(begin + share * frame_interval) * drive_.car.T_body_velo;
        },
        mix(seed, 2));
    write_file(folder_ / "velodyne_points/data" / sensors::numbered_file(frame, ".bin"),
               {reinterpret_cast<const char*>(points.data()), points.size() * sizeof(LidarPoint)});
  }

 private:
  const Drive& drive_;
  std::filesystem::path folder_;
  std::uint64_t seed_;
  RayScene scene_;
};

// False where it was broken off.
bool write_frames(const Drive& drive, const std::filesystem::path& folder,
                  const SimulationOptions& options, const FrameDone& frame_done) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;  // of what follows
  std::size_t done = 0;
  bool stop = false;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      FrameWriter writer(drive, folder, options.seed);
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

void write_frame_stamps(const Drive& drive, const std::filesystem::path& folder) {
  std::vector<Time> begin, middle, end;
  for (const double t : drive.times) {
    begin.push_back(drive_start + from_seconds(t - 0.5 * frame_interval));
    middle.push_back(drive_start + from_seconds(t));
    end.push_back(drive_start + from_seconds(t + 0.5 * frame_interval));
  }
  write_timestamps(folder / "image_00/timestamps.txt", middle);
  write_timestamps(folder / "image_01/timestamps.txt", middle);
  write_timestamps(folder / "velodyne_points/timestamps.txt", middle);
  write_timestamps(folder / "velodyne_points/timestamps_start.txt", begin);
  write_timestamps(folder / "velodyne_points/timestamps_end.txt", end);
}

void write_truth(const Drive& drive, const std::filesystem::path& file) {
  evaluation::StampedTrajectory truth;
  for (const double t : drive.times) {
    const Eigen::Isometry3d T_enu_cam = drive.motion.pose(t) * drive.car.stereo.T_body_cam;
    truth.stamps.push_back(drive_start + from_seconds(t));
    truth.poses.push_back(T_enu_cam);
  }
  const Eigen::Isometry3d T_first_enu = truth.poses.front().inverse();
  for (Eigen::Isometry3d& pose : truth.poses) pose = T_first_enu * pose;
  evaluation::write_tum(file, truth);
}

}  // namespace

bool simulate_drive(const std::filesystem::path& out, const SimulationOptions& options,
                    const FrameDone& frame_done) {
  namespace fs = std::filesystem;
  if (!(options.seconds >= 1.0 && options.seconds <= 3600.0))
    throw std::invalid_argument("a simulated drive takes 1 to 3600 s");
  if (fs::exists(out))
    throw std::runtime_error("'" + out.string() +
                             "' exists already: name another folder, or remove it");
  fs::path partial = out;
  partial += ".partial";
  fs::remove_all(partial);
  const fs::path sync = partial / "town_sync";
  for (const char* sensor : {"image_00", "image_01", "velodyne_points"})
    fs::create_directories(sync / sensor / "data");
  const Drive drive(options);
  const LocalFrame frame(town_origin);
  write_calibration(partial);
  write_frame_stamps(drive, sync);
  const ImuParameters imu = imu_parameters(options.imu);
  write_oxts(sync / "oxts", drive.motion, frame, drive_start, options.seconds, frame_interval, imu,
             options.seed);
  write_oxts(partial / "town_extract/oxts", drive.motion, frame, drive_start, options.seconds,
             fast_interval, imu, options.seed);
  write_road_map(partial / "map.osm", drive.streets, frame, options.seed);
  write_driven_links(partial / "driven_links.csv", drive.streets, drive.motion, drive.times);
  write_truth(drive, partial / "truth.tum");
  if (!write_frames(drive, sync, options, frame_done)) {
    fs::remove_all(partial);
    return false;
  }
  fs::rename(partial, out);
  return true;
}

}  // namespace maploop::simulate
