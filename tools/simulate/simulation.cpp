#include "tools/simulate/simulation.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "msgs/named_enum.h"
#include "msgs/vehicle_description.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/simulate/drive.h"
#include "tools/simulate/gnss/gnss_recording.h"
#include "tools/simulate/output_file.h"
#include "tools/simulate/sensors/frame_writer.h"
#include "tools/simulate/sensors/inertial_unit.h"
#include "tools/simulate/sensors/simulated_car.h"
#include "tools/simulate/town/height_tile.h"
#include "tools/simulate/town/road_map.h"

namespace maploop::simulate {
namespace {

namespace fs = std::filesystem;

void write_frame_stamps(const Drive& drive, const fs::path& folder,
                        const SimulatedSensors& sensors) {
  const auto write = [&](const char* file, const std::vector<double>& times, double later) {
    std::vector<Time> stamps;
    stamps.reserve(times.size());
    for (const double t : times) stamps.push_back(drive.start + from_seconds(t + later));
    write_timestamps(folder / file, stamps);
  };
  if (sensors.camera) {
    write("image_00/timestamps.txt", drive.times, drive.car.camera_delay);
    write("image_01/timestamps.txt", drive.times, drive.car.camera_delay);
  }
  if (!sensors.lidar) return;
  write("velodyne_points/timestamps.txt", drive.turns, 0.5 * drive.turn_time);
  write("velodyne_points/timestamps_start.txt", drive.turns, 0.0);
  write("velodyne_points/timestamps_end.txt", drive.turns, drive.turn_time);
}

void write_inertial(const Drive& drive, const fs::path& out, const SimulationOptions& options) {
  constexpr double fast_interval = 0.01;  // s between rows of the 100 Hz recording
  for (const auto& [name, interval] :
       {std::pair("town_sync", Drive::frame_interval), std::pair("town_extract", fast_interval)}) {
    write_oxts(out / name / "oxts", drive.motion, drive.frame, drive.start, options.seconds,
               interval, imu_parameters(options.imu), drive.car.imu_delay, options.seed);
  }
}

// Writes what a replay should know about the car.
void write_configuration(const fs::path& file, VehicleDescription d,
                         const SimulationOptions& options) {
  d.lidar.model = options.scanner == Scanner::vlp_16 ? "VLP-16" : "HDL-64E";
  // The float is rounded to the decimals that it stands for.
  const auto elevation = static_cast<double>(lidar_parameters(options.scanner).elevation_error);
  d.lidar.beam_elevation = std::round(1e8 * elevation) / 1e8;
  d.lidar.beam_elevation_sigma = 0.0005;
  write_file(
      file, fmt::format("# The simulated car.\n\n"
                        "imu_grade = \"{}\"\n\n"
                        "[map]\nfile = \"map.osm\"\n\n"
                        "[wheel]\nerrors = \"drawn\"  # its tyres are worn and slip\nseed = {}\n{}",
                        to_string(options.imu), options.seed % 1'000'000'000, to_toml(d)));
}

void write_truth(const Drive& drive, const fs::path& file) {
  evaluation::StampedTrajectory truth;
  for (const double t : drive.times) {
    const Eigen::Isometry3d T_enu_cam = drive.motion.pose(t) * drive.calibration.stereo.T_body_cam;
    truth.stamps.push_back(drive.start + from_seconds(t));
    truth.poses.push_back(T_enu_cam);
  }
  const Eigen::Isometry3d T_first_enu = truth.poses.front().inverse();
  for (Eigen::Isometry3d& pose : truth.poses) pose = T_first_enu * pose;
  evaluation::write_tum(file, truth);
}

// Returns false if `frame_done` stopped it.
bool write_drive(const fs::path& out, const SimulationOptions& options,
                 const FrameDone& frame_done) {
  const Drive drive(options);
  const fs::path sync = out / "town_sync";
  const SimulatedSensors& sensors = options.sensors;
  fs::create_directories(sync);
  for (const char* camera : {"image_00", "image_01"})
    if (sensors.camera) fs::create_directories(sync / camera / "data");
  if (sensors.lidar) fs::create_directories(sync / "velodyne_points/data");
  write_calibration(out, drive.car);
  write_frame_stamps(drive, sync, sensors);
  if (sensors.imu) write_inertial(drive, out, options);
  if (sensors.gnss) {
    write_gnss(sync, {drive.motion, drive.car.antenna, drive.traffic, *drive.world, drive.frame,
                      drive.start, options.seconds, options.gnss_rate, options.seed});
  }
  if (options.heights) {
    write_height_tile(out / "heights", {*drive.world, drive.terrain, drive.index.least(),
                                        drive.index.most(), drive.frame, options.seed});
  }
  write_road_map(out / "map.osm", drive.streets, drive.frame, options.seed);
  write_configuration(out / "vehicle.toml", description_of(drive.car), options);
  if (options.car == CarKind::drawn) {
    write_configuration(out / "vehicle_rough.toml", rough_description(drive.car, options.seed),
                        options);
  }
  write_driven_links(out / "driven_links.csv", drive.streets, drive.motion, drive.times);
  write_truth(drive, out / "truth.tum");
  const bool frames = sensors.camera || sensors.lidar;
  return !frames || write_frames(drive, sync, options, frame_done);
}

}  // namespace

bool simulate_drive(const fs::path& out, const SimulationOptions& options,
                    const FrameDone& frame_done) {
  if (!(options.seconds >= 1.0 && options.seconds <= most_seconds))
    throw std::invalid_argument(fmt::format("a simulated drive takes 1 to {:.0f} s", most_seconds));
  if (fs::exists(out)) {
    throw std::runtime_error("'" + out.string() +
                             "' exists already: name another folder, or remove it");
  }
  fs::path partial = out;
  partial += ".partial";
  std::error_code error;
  fs::remove_all(partial, error);
  fs::create_directories(partial, error);
  if (error) {
    throw std::runtime_error("cannot make the folder '" + partial.string() +
                             "': " + error.message() + "; name a place that can be written");
  }
  bool complete = false;
  try {
    complete = write_drive(partial, options, frame_done);
    if (complete) fs::rename(partial, out);
  } catch (...) {
    fs::remove_all(partial, error);
    throw;
  }
  if (!complete) fs::remove_all(partial, error);
  return complete;
}

}  // namespace maploop::simulate
