// Opens the input of an odometry that runs alone: a drive's images or recorded tracks.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "msgs/calibration.h"
#include "runtime/vehicle/config/vehicle_config.h"
#include "runtime/vehicle/drivers/recording.h"
#include "tools/evaluate/motion_chain.h"
#include "tools/evaluate/trajectory_file.h"
#include "tools/odometry/stereo_runs.h"

namespace maploop::odometry {

// Names the input and what is known of it.
struct InputFiles {
  std::filesystem::path input;
  std::filesystem::path config;     // empty: the defaults
  std::vector<std::string> topics;  // of a bag, SENSOR=TOPIC
};

// Final changes to the parameters, which are those of a file or the defaults.
using Adjust = std::function<void(stereo::StereoParameters&)>;

struct Input {
  Run run;
  StereoCalibration camera;
};

// Opens whatever maploop replay takes, and tells the user what was assumed about it. Returns the
// configuration, which the recording completes.
vehicle::VehicleConfig open_recording(const InputFiles& files, vehicle::Recording* recording);

// The input is a recording with images, or recorded tracks: <drive>.csv[.gz] with its .meta.json.
// Without a configuration, recorded tracks get for_recorded_tracks(). Throws std::runtime_error and
// std::invalid_argument naming file, key or value, or if there are no scans for Disparities::lidar.
Input open_input(const InputFiles& files, FrameRange frames, Disparities disparities,
                 const Adjust& adjust);

// Reads the left camera's truth that belongs to the input: a recording's reference at its images'
// stamps, or the <drive>.truth.csv[.gz] beside recorded tracks. Throws std::runtime_error if there
// is none.
evaluation::StampedTrajectory read_truth(const InputFiles& files);

// Accumulates the left camera's path in its first frame.
class CameraPath {
 public:
  explicit CameraPath(const Eigen::Isometry3d& T_body_cam) : T_body_cam_(T_body_cam) {}

  void add(const RelativeMotion& motion);
  const evaluation::StampedTrajectory& trajectory() const { return trajectory_; }

 private:
  Eigen::Isometry3d T_body_cam_;
  evaluation::MotionChain chain_;
  evaluation::StampedTrajectory trajectory_;
};

}  // namespace maploop::odometry
