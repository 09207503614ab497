// Recorded drives with an odometry of known drift, for the filter's tests on real data.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

#include "msgs/gnss.h"
#include "msgs/imu.h"
#include "msgs/odometry.h"

namespace maploop::testing {

struct RecordedDrive {
  std::string name;
  std::vector<ImuSample> imu;
  std::vector<RelativeMotion> odometry;  // available 60 ms after its stamp
  // At each odometry stamp, after a first one at the first interval's start; T_enu_body.
  std::vector<Time> stamps;
  std::vector<Eigen::Isometry3d> truth;
  GnssFix start;  // truth plus noise, at the first of the stamps
};

// What the odometry's covariance says of each interval.
struct OdometrySigmas {
  double speed;     // m/s
  double rotation;  // rad
};

// A drive of kitti_odometry/tracks: 10 Hz inertial data, the sanity odometry of sparse tracks (its
// usable frames, where the truth is real). The
// horizontal axes are those of the vehicle at the first frame (x counts as east), made level by
// comparing the recorder's levelled accelerations with the body's; the truth's Mercator metres are
// taken as metres (0.2 %).
RecordedDrive load_track_drive(const std::filesystem::path& data, const std::string& name,
                               const OdometrySigmas& sigmas, unsigned seed = 1);

// Odometry sequence 00 with the 100 Hz inertial sensor (invented samples left out, so that it is
// silent for 1.6 s eight times) and the frame-to-frame motion of a stereo SLAM system as odometry.
// Truth in metric WGS84.
RecordedDrive load_sequence_00(const std::filesystem::path& data, const OdometrySigmas& sigmas,
                               unsigned seed = 1);

}  // namespace maploop::testing
