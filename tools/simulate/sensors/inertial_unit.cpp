#include "tools/simulate/sensors/inertial_unit.h"

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

#include "msgs/frames.h"
#include "sensors/replay/files.h"
#include "tools/simulate/output_file.h"

namespace maploop::simulate {
namespace {

constexpr std::array<double, 3> correlation_times{10.0, 100.0, 1000.0};  // s
constexpr double milli_g = 9.80665e-3;                                   // m/s^2

constexpr double degrees_per_hour(double value) {
  return radians(value) / 3600.0;
}

constexpr double gravity = 9.81;  // m/s^2

constexpr const char* row_format =
    "lat: deg\nlon: deg\nalt: m\nroll: rad, left side up\npitch: rad, front down\n"
    "yaw: rad, 0 = east, counter clockwise\nvn: m/s\nve: m/s\nvf: m/s\nvl: m/s\nvu: m/s\n"
    "ax: m/s^2, body\nay: m/s^2\naz: m/s^2\naf: m/s^2, level\nal: m/s^2\nau: m/s^2\n"
    "wx: rad/s, body\nwy: rad/s\nwz: rad/s\nwf: rad/s, level\nwl: rad/s\nwu: rad/s\n"
    "pos_accuracy: m\nvel_accuracy: m/s\nnavstat\nnumsats\nposmode\nvelmode\norimode\n";

std::string oxts_row_text(const VehicleState& now, const VehicleState& before,
                          const LocalFrame& frame, TriadErrors& gyros,
                          TriadErrors& accelerometers) {
  const Geodetic place = frame.to_geodetic(now.T_enu_body.translation());
  const Attitude attitude = attitude_from_rotation(now.T_enu_body.linear());
  const Eigen::Matrix3d& R = before.T_enu_body.linear();
  const Eigen::Vector3d force =
      before.acceleration_enu + gravity * Eigen::Vector3d::UnitZ();  // specific force, enu
  const Eigen::Vector3d a = accelerometers.measure(R.transpose() * force);
  const Eigen::Vector3d w = gyros.measure(before.rate_body);
  const Eigen::Matrix3d level =
      Eigen::AngleAxisd(-yaw_from_azimuth(attitude_from_rotation(R).azimuth),
                        Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  const Eigen::Vector3d &v = before.velocity_enu, v_level = level * v;
  const Eigen::Vector3d a_level = level * (R * a), w_level = level * (R * w);
  char text[1024];
  const int length = std::snprintf(
      text, sizeof text,
      "%.12f %.12f %.6f %.10f %.10f %.10f %.9f %.9f %.9f %.9f %.9f %.9f %.9f %.9f %.9f %.9f %.9f "
      "%.10f %.10f %.10f %.10f %.10f %.10f 0.02 0.02 4 10 4 4 6\n",
      degrees(place.latitude), degrees(place.longitude), place.height, attitude.roll,
      -attitude.pitch, yaw_from_azimuth(attitude.azimuth), v.y(), v.x(), v_level.x(), v_level.y(),
      v_level.z(), a.x(), a.y(), a.z(), a_level.x(), a_level.y(), a_level.z(), w.x(), w.y(), w.z(),
      w_level.x(), w_level.y(), w_level.z());
  return {text, static_cast<std::size_t>(length)};
}

}  // namespace

ImuParameters imu_parameters(ImuGrade grade) {
  const double root_hour = radians(1.0) / 60.0;  // deg/sqrt(h) in rad/sqrt(s)
  if (grade == ImuGrade::tactical) {
    return {{degrees_per_hour(2.0), degrees_per_hour(2.0), 0.2 * root_hour, 5e-4, 2e-4},
            {1.0 * milli_g, 0.05 * milli_g, 1e-3, 5e-4, 2e-4}};
  }
  return {{degrees_per_hour(300.0), degrees_per_hour(10.0), 0.3 * root_hour, 2e-3, 2e-3},
          {20.0 * milli_g, 0.2 * milli_g, 2e-3, 2e-3, 2e-3}};
}

TriadErrors::TriadErrors(const TriadParameters& parameters, double interval, std::uint64_t seed,
                         std::uint64_t stream)
    : parameters_(parameters),
      interval_(interval),
      random_(seed, from_nanoseconds(static_cast<std::int64_t>(stream))) {
  turn_on_ = parameters_.turn_on * normal();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      shape_(row, column) = row == column ? 1.0 + parameters_.scale * random_.next()
                                          : parameters_.misalignment * random_.next();
    }
  }
  for (Eigen::Vector3d& process : flicker_)
    process = parameters_.instability / std::sqrt(3.0) * normal();
}

Eigen::Vector3d TriadErrors::normal() {
  const double x = random_.next(), y = random_.next();
  return {x, y, random_.next()};
}

Eigen::Vector3d TriadErrors::measure(const Eigen::Vector3d& truth) {
  Eigen::Vector3d measured = shape_ * truth + turn_on_;
  for (std::size_t i = 0; i < flicker_.size(); ++i) {
    const double keep = std::exp(-interval_ / correlation_times[i]);
    flicker_[i] = keep * flicker_[i] +
                  parameters_.instability * std::sqrt((1.0 - keep * keep) / 3.0) * normal();
    measured += flicker_[i];
  }
  return measured + parameters_.white / std::sqrt(interval_) * normal();
}

void write_timestamps(const std::filesystem::path& file, const std::vector<Time>& stamps) {
  std::string text;
  for (const Time stamp : stamps) text += format_time(stamp) + '\n';
  write_file(file, text);
}

void write_oxts(const std::filesystem::path& oxts, const VehicleMotion& motion,
                const LocalFrame& frame, Time start, double seconds, double interval,
                const ImuParameters& imu, double delay, std::uint64_t seed) {
  std::filesystem::create_directories(oxts / "data");
  TriadErrors gyros(imu.gyros, interval, seed, 1);
  TriadErrors accelerometers(imu.accelerometers, interval, seed, 2);
  std::vector<Time> stamps;
  for (std::size_t i = 0; static_cast<double>(i) * interval < seconds; ++i) {
    const double t = static_cast<double>(i) * interval;
    stamps.push_back(start + from_seconds(t));
    write_file(
        oxts / "data" / sensors::numbered_file(i, ".txt"),
        oxts_row_text(motion.state(t), motion.state(t - delay), frame, gyros, accelerometers));
  }
  write_timestamps(oxts / "timestamps.txt", stamps);
  write_file(oxts / "dataformat.txt", row_format);
}

}  // namespace maploop::simulate
