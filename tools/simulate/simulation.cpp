#include "tools/simulate/simulation.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tools/evaluate/trajectory_file.h"
#include "tools/simulate/drive.h"
#include "tools/simulate/gnss/gnss_recording.h"
#include "tools/simulate/gnss/receiver.h"
#include "tools/simulate/output_file.h"
#include "tools/simulate/sensors/frame_writer.h"
#include "tools/simulate/sensors/oxts_rows.h"
#include "tools/simulate/sensors/test_car.h"
#include "tools/simulate/town/road_map.h"

namespace maploop::simulate {
namespace {

constexpr double fast_interval = 0.01;  // s between rows of the 100 Hz recording

// Returns false if `frame_done` stopped it.
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

void write_frame_stamps(const Drive& drive, const std::filesystem::path& folder,
                        const SimulatedSensors& sensors) {
  const auto stamps = [&drive](const std::vector<double>& times, double later) {
    std::vector<Time> result;
    for (const double t : times) result.push_back(drive.start + from_seconds(t + later));
    return result;
  };
  if (sensors.camera) {
    write_timestamps(folder / "image_00/timestamps.txt", stamps(drive.times, 0.0));
    write_timestamps(folder / "image_01/timestamps.txt", stamps(drive.times, 0.0));
  }
  if (!sensors.lidar) return;
  const auto& turns = drive.turns;
  const std::filesystem::path scans = folder / "velodyne_points";
  write_timestamps(scans / "timestamps.txt", stamps(turns, 0.5 * drive.turn_time));
  write_timestamps(scans / "timestamps_start.txt", stamps(turns, 0.0));
  write_timestamps(scans / "timestamps_end.txt", stamps(turns, drive.turn_time));
}

void write_inertial(const Drive& drive, const std::filesystem::path& folder,
                    const LocalFrame& frame, const SimulationOptions& options) {
  const ImuParameters imu = imu_parameters(options.imu);
  write_oxts(folder / "town_sync/oxts", drive.motion, frame, drive.start, options.seconds,
             Drive::frame_interval, imu, options.seed);
  write_oxts(folder / "town_extract/oxts", drive.motion, frame, drive.start, options.seconds,
             fast_interval, imu, options.seed);
}

// Writes what a replay should know about the car. The car's origin is above the rear axle and moves
// along body x, except for the motion of its springs (vehicle_motion.h).
void write_configuration(const std::filesystem::path& file, const SimulationOptions& options) {
  const Eigen::Vector3d& lever = Receiver::lever();
  const char* name = options.scanner == Scanner::vlp_16 ? "VLP-16" : "HDL-64E";
  char text[1024];
  const int length = std::snprintf(
      text, sizeof text,
      "# The simulated car.\n\n"
      "imu_grade = \"%s\"\n\n"
      "[map]\nfile = \"map.osm\"\n\n"
      "[live]\nvelodyne_model = \"%s\"\n\n"
      "[lidar]\nelevation_correction = %.8f  # rad, that all beams point higher than they say\n\n"
      "[fusion]\n"
      "rear_axle_distance = 0.0  # m, the inertial unit is above the rear axle\n"
      "climb_offset = 0.0  # rad, and level, ...\n"
      "climb_offset_sigma = 0.0087  # rad, ... but on springs\n"
      "gnss_lever_forward = %.2f  # m, the GNSS antenna from the inertial unit\n"
      "gnss_lever_left = %.2f\ngnss_lever_up = %.2f\n\n"
      "[wheel]\nerrors = \"drawn\"  # its tyres are worn and slip\nseed = %d\n",
      options.imu == ImuGrade::mems ? "mems" : "tactical", name,
      static_cast<double>(lidar_parameters(options.scanner).elevation_error), lever.x(), lever.y(),
      lever.z(), static_cast<int>(options.seed % 1'000'000'000));
  write_file(file, {text, static_cast<std::size_t>(length)});
}

void write_truth(const Drive& drive, const std::filesystem::path& file) {
  evaluation::StampedTrajectory truth;
  for (const double t : drive.times) {
    const Eigen::Isometry3d T_enu_cam = drive.motion.pose(t) * drive.car.stereo.T_body_cam;
    truth.stamps.push_back(drive.start + from_seconds(t));
    truth.poses.push_back(T_enu_cam);
  }
  const Eigen::Isometry3d T_first_enu = truth.poses.front().inverse();
  for (Eigen::Isometry3d& pose : truth.poses) pose = T_first_enu * pose;
  evaluation::write_tum(file, truth);
}

// The drive's folder while it is being written; the destructor removes an unfinished one.
class PartialFolder {
 public:
  explicit PartialFolder(const std::filesystem::path& out) : out_(out), partial_(out) {
    partial_ += ".partial";
    std::error_code error;
    std::filesystem::remove_all(partial_, error);
    std::filesystem::create_directories(partial_, error);
    if (error) {
      throw std::runtime_error("cannot make the folder '" + partial_.string() +
                               "': " + error.message() + "; name a place that can be written");
    }
  }
  ~PartialFolder() {
    std::error_code ignored;
    if (!finished_) std::filesystem::remove_all(partial_, ignored);
  }
  PartialFolder(const PartialFolder&) = delete;
  PartialFolder& operator=(const PartialFolder&) = delete;

  const std::filesystem::path& path() const { return partial_; }
  void finish() {
    std::filesystem::rename(partial_, out_);
    finished_ = true;
  }

 private:
  std::filesystem::path out_, partial_;
  bool finished_ = false;
};

}  // namespace

bool simulate_drive(const std::filesystem::path& out, const SimulationOptions& options,
                    const FrameDone& frame_done) {
  namespace fs = std::filesystem;
  if (!(options.seconds >= 1.0 && options.seconds <= 3600.0))
    throw std::invalid_argument("a simulated drive takes 1 to 3600 s");
  if (fs::exists(out))
    throw std::runtime_error("'" + out.string() +
                             "' exists already: name another folder, or remove it");
  PartialFolder folder(out);
  const fs::path& partial = folder.path();
  const Drive drive(options);
  const fs::path sync = partial / "town_sync";
  const SimulatedSensors& sensors = options.sensors;
  fs::create_directories(sync);
  for (const char* camera : {"image_00", "image_01"})
    if (sensors.camera) fs::create_directories(sync / camera / "data");
  if (sensors.lidar) fs::create_directories(sync / "velodyne_points/data");
  const LocalFrame& frame = drive.frame;
  write_calibration(partial);
  write_frame_stamps(drive, sync, sensors);
  if (sensors.imu) write_inertial(drive, partial, frame, options);
  if (sensors.gnss)
    write_gnss(sync, {drive.motion, drive.traffic, *drive.world, frame, drive.start,
                      options.seconds, options.gnss_rate, options.seed});
  write_road_map(partial / "map.osm", drive.streets, frame, options.seed);
  write_configuration(partial / "vehicle.toml", options);
  write_driven_links(partial / "driven_links.csv", drive.streets, drive.motion, drive.times);
  write_truth(drive, partial / "truth.tum");
  const bool frames = sensors.camera || sensors.lidar;
  if (frames && !write_frames(drive, sync, options, frame_done)) return false;
  folder.finish();
  return true;
}

}  // namespace maploop::simulate
