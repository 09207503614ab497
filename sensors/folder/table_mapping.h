// This file says which columns of which tables are what a sensor measured.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/time.h"

namespace maploop::sensors {

// gps_week: two columns, the week and the second of it.
enum class TimeUnit : std::uint8_t { s, ms, us, ns, gps_week };
constexpr std::array<std::string_view, 5> names_of(TimeUnit) {
  return {"s", "ms", "us", "ns", "gps week"};
}

// local: x east, y north, z up, in m, from an origin that nobody knows.
enum class PositionForm : std::uint8_t { geodetic, ecef, local };
constexpr std::array<std::string_view, 3> names_of(PositionForm) {
  return {"geodetic", "ecef", "local"};
}

enum class VelocityAxes : std::uint8_t { ned, enu, ecef };
constexpr std::array<std::string_view, 3> names_of(VelocityAxes) {
  return {"ned", "enu", "ecef"};
}

// Names the columns of a quantity; none: the table does not have it. A value of the file times
// `unit` is in m, m/s, m/s^2, rad/s; or in degrees.
struct Columns {
  std::vector<std::string> names = {};
  double unit = 1.0;

  bool given() const { return !names.empty(); }
};

struct TableFile {
  std::filesystem::path file = {};        // .csv, .npy or .pos, plain or .gz; empty: none
  std::vector<std::string> columns = {};  // names, where the file has no heading
  std::vector<std::string> time = {"time"};
  TimeUnit time_unit = TimeUnit::s;
  bool gps_time = false;  // no leap seconds

  bool given() const { return !file.empty(); }
};

struct ImuTable : TableFile {
  Columns gyro, accelerometer;
};

struct GnssTable : TableFile {
  PositionForm form = PositionForm::geodetic;
  Columns position;  // latitude, longitude (deg), height (m); or x, y, z
  Columns velocity;  // without them, they follow from the positions
  VelocityAxes velocity_axes = VelocityAxes::ned;
  Columns position_sigma, velocity_sigma;  // of north, east, and down or up
  double default_position_sigma = 3.0;     // m, of each axis, without columns; heights 1.5 times
  double default_velocity_sigma = 0.3;     // m/s
  Columns quality;                         // rows with 0 are not fixes
};

struct WheelTable : TableFile {
  Columns speed;
  double sigma = 0.1;  // m/s
};

// A truth, or another fusion of the same sensors.
struct ReferenceTable : TableFile {
  PositionForm form = PositionForm::geodetic;
  Columns position, velocity;
  VelocityAxes velocity_axes = VelocityAxes::ned;
  // Of the body: roll, pitch, yaw in degrees (axes forward, right, down; yaw from north); or the
  // quaternion w, x, y, z that takes the unit's axes to east, north, up.
  Columns attitude, quaternion;
  TableFile attitude_file;                                    // where they are in another one
  Eigen::Matrix3d R_unit_body = Eigen::Matrix3d::Identity();  // of the quaternion's axes
  double accuracy = 1.0;                                      // m
  bool peer = true;  // it is a fusion of the same sensors, which may leap
};

struct TableMapping {
  ImuTable imu;
  GnssTable gnss;
  WheelTable wheel;
  ReferenceTable reference;
  // Converts a GPS time, written as if it were UTC, to UTC. Needed for times of GPS.
  Time (*utc_of_gps)(Time gps) = nullptr;
};

// Returns the built-in mapping of a folder with gnss.csv, imu.csv, reference_position.csv and
// reference_attitude.csv, as sensors/FORMATS.md describes them.
TableMapping plain_tables(const std::filesystem::path& folder);

}  // namespace maploop::sensors
