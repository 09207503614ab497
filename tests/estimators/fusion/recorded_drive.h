// These are recorded drives with an odometry of known drift, for tests of the filter on real data.
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
  // These are given at each odometry stamp, preceded by the start of the first interval;
  // T_enu_body.
  std::vector<Time> stamps;
  std::vector<Eigen::Isometry3d> truth;
  GnssFix start;  // truth plus noise, at the first of the stamps
};

// These standard deviations form the odometry's covariance of each interval.
struct OdometrySigmas {
  double speed;     // m/s
  double rotation;  // rad
};

// Loads a drive of kitti_odometry/tracks: 10 Hz inertial data, and the baseline odometry of sparse
// tracks (its usable frames, for which the truth is real). The horizontal axes are those of the
// vehicle at the first frame (x counts as east). They are levelled by comparing the recorder's
// levelled accelerations with those of the body. The truth's Mercator units are taken as metres
// (0.2 % error).
RecordedDrive load_track_drive(const std::filesystem::path& data, const std::string& name,
                               const OdometrySigmas& sigmas, unsigned seed = 1);

// Loads odometry sequence 00 with the 100 Hz inertial sensor and the frame-to-frame motion of a
// stereo SLAM system as odometry. Samples invented by the recorder are removed, so the sensor is
// silent for 1.6 s eight times. The truth is in metric WGS84.
RecordedDrive load_sequence_00(const std::filesystem::path& data, const OdometrySigmas& sigmas,
                               unsigned seed = 1);

}  // namespace maploop::testing
