// This file reads the rows of KITTI's inertial and GNSS unit (OXTS RT3003): one text file of 30
// numbers each.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "msgs/frames.h"
#include "msgs/imu.h"
#include "msgs/local_frame.h"
#include "sensors/replay/timestamps.h"

namespace maploop::sensors {

// These are the values used of a row. Only rates and accelerations about the body's own axes (ax,
// ay, az, wx, wy, wz) are taken: af, al and wu are levelled with the unit's own attitude, and would
// leak the reference into the estimate.
struct OxtsRow {
  Geodetic position;
  Attitude attitude;
  Eigen::Vector3d velocity_enu = Eigen::Vector3d::Zero();  // m/s
  InertialValues inertial;
  double forward_speed = 0.0;      // m/s along-track, of vf and vu
  double position_accuracy = 0.0;  // m
};

// Parses the columns that the drive's oxts/dataformat.txt lists. KITTI's attitude is R_enu_imu =
// Rz(yaw) Ry(pitch) Rx(roll), pitch nose down. Throws std::invalid_argument whose text is the
// reason only: not 30 columns, not finite, or outside the range of its kind.
OxtsRow parse_oxts_row(std::string_view text);
// Does the same for numbers.
OxtsRow oxts_row(std::span<const double> values);

struct OxtsRows {
  std::vector<OxtsRow> rows;
  std::vector<Time> stamps;        // of the rows' position and attitude
  Verdicts verdicts;               // one for each row
  std::vector<Finding> unstamped;  // row files beyond the last stamp
};

// Reads all rows of the folder `oxts` of a drive. Throws std::runtime_error if its timestamps.txt
// is missing or empty; a row that is missing or unusable gets a verdict.
OxtsRows read_oxts(const std::filesystem::path& folder);
OxtsRows read_oxts(const std::filesystem::path& folder, Timestamps timestamps);

}  // namespace maploop::sensors
