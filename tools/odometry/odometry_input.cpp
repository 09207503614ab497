#include "tools/odometry/odometry_input.h"

#include <iostream>
#include <optional>
#include <stdexcept>

#include "sensors/replay/reference_trajectory.h"

namespace maploop::odometry {
namespace {

bool are_tracks(const std::filesystem::path& input) {
  std::filesystem::path name = input.filename();
  if (name.extension() == ".gz") name.replace_extension();
  return name.extension() == ".csv";
}

Input open_images(const InputFiles& files, FrameRange frames, Disparities disparities,
                  const Adjust& adjust) {
  vehicle::Recording recording;
  vehicle::VehicleConfig config = open_recording(files, &recording);
  if (recording.sensors(Time::max()).camera == nullptr) {
    throw std::runtime_error("'" + files.input.string() +
                             "' has no images of a pair of cameras; --lidar uses its scans");
  }
  adjust(config.stereo);
  std::optional<lidar::LidarParameters> depth;
  if (disparities == Disparities::lidar) depth = config.lidar;
  return {stereo_run(recording, config.stereo, frames, depth), recording.calibration.stereo};
}

Input open_tracks(const InputFiles& files, FrameRange frames, const Adjust& adjust) {
  stereo::StereoParameters parameters = files.config.empty()
                                            ? for_recorded_tracks()
                                            : vehicle::load_vehicle_config(files.config).stereo;
  adjust(parameters);
  auto tracks = std::make_shared<const RecordedTracks>(read_recorded_tracks(files.input));
  return {tracks_run(tracks, parameters, frames), tracks->calibration};
}

evaluation::StampedTrajectory truth_of_recording(const InputFiles& files) {
  vehicle::Recording recording;
  open_recording(files, &recording);
  const vehicle::Sensors sensors = recording.sensors(Time::max());
  const auto rows = sensors::read_rows(recording.sensors(Time::max()).reference);
  if (rows.size() < 2 || sensors.camera == nullptr) {
    throw std::runtime_error(files.input.string() +
                             " has no reference (KITTI: the folder oxts) to score images against");
  }
  const sensors::ReferenceTrajectory reference(rows, LocalFrame(rows.front().position));
  evaluation::StampedTrajectory truth;
  for (StereoPair pair; sensors.camera->next(pair);) {
    const auto T_enu_body = reference.pose(pair.stamp);
    if (!T_enu_body) continue;
    truth.stamps.push_back(pair.stamp);
    truth.poses.push_back(*T_enu_body * recording.calibration.stereo.T_body_cam);
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

vehicle::VehicleConfig open_recording(const InputFiles& files, vehicle::Recording* recording) {
  vehicle::VehicleConfig config = vehicle::load_vehicle_config(files.config, {}, files.topics);
  config.ppp.observations = false;  // odometry does not need them
  *recording = vehicle::open_recording(files.input, config);
  for (const std::string& note : recording->notes) std::cerr << "maploop: " << note << '\n';
  describe_car(config, recording->calibration);
  return config;
}

Input open_input(const InputFiles& files, FrameRange frames, Disparities disparities,
                 const Adjust& adjust) {
  const Adjust with_offset = [&](stereo::StereoParameters& parameters) {
    adjust(parameters);
    if (disparities == Disparities::none) parameters.sigma_disparity_offset = 0.0;
  };
  if (!are_tracks(files.input)) return open_images(files, frames, disparities, with_offset);
  if (disparities == Disparities::lidar) {
    throw std::runtime_error("'" + files.input.string() +
                             "' are recorded tracks, which have no scans; leave --disparity lidar "
                             "out");
  }
  return open_tracks(files, frames, with_offset);
}

evaluation::StampedTrajectory read_truth(const InputFiles& files) {
  return are_tracks(files.input) ? truth_of_tracks(files.input) : truth_of_recording(files);
}

void CameraPath::add(const RelativeMotion& motion) {
  trajectory_.stamps.push_back(motion.stamp);
  trajectory_.poses.push_back(T_body_cam_.inverse() * chain_.add(motion) * T_body_cam_);
}

}  // namespace maploop::odometry
