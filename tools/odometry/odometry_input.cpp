#include "tools/odometry/odometry_input.h"

#include <optional>
#include <stdexcept>

#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/recording.h"
#include "sensors/replay/reference_trajectory.h"

namespace maploop::odometry {
namespace {

Input open_drive(const std::filesystem::path& folder, const std::filesystem::path& file,
                 FrameRange frames, Disparities disparities, const Adjust& adjust) {
  vehicle::VehicleConfig config;
  if (!file.empty()) config = vehicle::load_vehicle_config(file);
  adjust(config.stereo);
  const auto drive = vehicle::open_drive(folder, config);
  describe_car(config, drive->calibration());
  std::optional<lidar::LidarParameters> depth;
  if (disparities == Disparities::lidar) depth = config.lidar;
  return {stereo_run(*drive, config.stereo, frames, depth), drive->calibration().stereo, drive};
}

Input open_tracks(const std::filesystem::path& file, const std::filesystem::path& config,
                  FrameRange frames, const Adjust& adjust) {
  stereo::StereoParameters parameters =
      config.empty() ? for_recorded_tracks() : vehicle::load_vehicle_config(config).stereo;
  adjust(parameters);
  auto tracks = std::make_shared<const RecordedTracks>(read_recorded_tracks(file));
  return {tracks_run(tracks, parameters, frames), tracks->calibration, tracks};
}

evaluation::StampedTrajectory truth_of_drive(const std::filesystem::path& folder,
                                             const std::filesystem::path& file) {
  const auto drive = vehicle::open_drive(
      folder, file.empty() ? vehicle::VehicleConfig{} : vehicle::load_vehicle_config(file));
  const auto rows = sensors::read_rows(drive->reference());
  if (rows.size() < 2) throw std::runtime_error(folder.string() + " has no oxts to score against");
  const sensors::ReferenceTrajectory reference(rows, LocalFrame(rows.front().position));
  evaluation::StampedTrajectory truth;
  const auto camera = drive->camera();
  for (StereoPair pair; camera->next(pair);) {
    const auto T_enu_body = reference.pose(pair.stamp);
    if (!T_enu_body) continue;
    truth.stamps.push_back(pair.stamp);
    truth.poses.push_back(*T_enu_body * drive->calibration().stereo.T_body_cam);
  }
  return truth;
}

// Reads <drive>.truth.csv[.gz] for <drive>.csv[.gz].
evaluation::StampedTrajectory truth_of_tracks(const std::filesystem::path& file) {
  std::string name = file.string();
  const std::size_t dot = name.rfind(".csv");
  if (dot == std::string::npos)
    throw std::runtime_error(name + ": recorded tracks are a .csv or .csv.gz");
  return evaluation::read_trajectory(name.insert(dot, ".truth"));
}

}  // namespace

Input open_input(const std::filesystem::path& input, const std::filesystem::path& config,
                 FrameRange frames, Disparities disparities, const Adjust& adjust) {
  const Adjust with_offset = [&](stereo::StereoParameters& parameters) {
    adjust(parameters);
    if (disparities == Disparities::none) parameters.sigma_disparity_offset = 0.0;
  };
  if (std::filesystem::is_directory(input))
    return open_drive(input, config, frames, disparities, with_offset);
  if (disparities == Disparities::lidar)
    throw std::runtime_error("'" + input.string() +
                             "' is no folder of a drive, and recorded tracks have no scans; leave "
                             "--disparity lidar out");
  return open_tracks(input, config, frames, with_offset);
}

evaluation::StampedTrajectory read_truth(const std::filesystem::path& input,
                                         const std::filesystem::path& config) {
  return std::filesystem::is_directory(input) ? truth_of_drive(input, config)
                                              : truth_of_tracks(input);
}

void CameraPath::add(const RelativeMotion& motion) {
  trajectory_.stamps.push_back(motion.stamp);
  trajectory_.poses.push_back(T_body_cam_.inverse() * chain_.add(motion) * T_body_cam_);
}

}  // namespace maploop::odometry
