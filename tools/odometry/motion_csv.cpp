#include "tools/odometry/motion_csv.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "msgs/frames.h"
#include "tools/evaluate/text_file.h"

namespace maploop::odometry {
namespace {

constexpr const char* motion_columns =
    "x,y,z,rx,ry,rz,sigma_x,sigma_y,sigma_z,sigma_rx,sigma_ry,sigma_rz,tracked,inliers,";
std::string speed_cells(const RelativeMotion& m) {
  if (m.status != OdometryStatus::ok) return std::string(4, ',');
  const double seconds = to_seconds(m.stamp - m.from);
  const Eigen::Matrix3d R = m.rotation.toRotationMatrix();
  return fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g}", m.translation.x() / seconds,
                     std::sqrt(m.covariance(0, 0)) / seconds,
                     -degrees(std::atan2(R(1, 0), R(0, 0))),
                     degrees(std::sqrt(m.covariance(5, 5))));
}

std::string stamp_cells(std::uint64_t frame, const RelativeMotion& m) {
  const auto seconds = [](Time t) { return static_cast<double>(to_nanoseconds(t)) * 1e-9; };
  const std::string text = fmt::format("{},{:.6f},", frame, seconds(m.stamp));
  return m.status == OdometryStatus::ok ? fmt::format("{}{:.6f}", text, seconds(m.from)) : text;
}

std::string motion_cells(const RelativeMotion& m) {
  if (m.status != OdometryStatus::ok) return std::string(12, ',');
  const Eigen::AngleAxisd turn(m.rotation);
  const Eigen::Vector3d rotation = turn.angle() * turn.axis();
  const Eigen::Matrix<double, 6, 1> sigma = m.covariance.diagonal().cwiseSqrt();
  std::string text;
  for (int i = 0; i < 3; ++i) text += fmt::format(",{:.9g}", m.translation[i]);
  for (int i = 0; i < 3; ++i) text += fmt::format(",{:.9g}", degrees(rotation[i]));
  for (int i = 0; i < 3; ++i) text += fmt::format(",{:.9g}", sigma[i]);
  for (int i = 3; i < 6; ++i) text += fmt::format(",{:.9g}", degrees(sigma[i]));
  return text;
}

std::string directions(std::uint8_t bits) {
  std::string names;
  for (unsigned i = 0; i < 6; ++i) {
    if ((bits >> i & 1u) == 0) continue;
    names.append(names.empty() ? "" : "+").append(to_string(static_cast<MotionDirection>(i)));
  }
  return names;
}

}  // namespace

void write_csv(const std::filesystem::path& file, std::span<const Step> steps) {
  std::string text = fmt::format(
      "frame,stamp,from,status,{}forward_speed,sigma_forward_speed,azimuth_increment,"
      "sigma_azimuth_increment,condition,parallax,milliseconds\n",
      motion_columns);
  for (const Step& step : steps) {
    const RelativeMotion& m = step.motion;
    text += fmt::format("{},{}{},{},{}{},{},{:.9g},{:.9g}\n", stamp_cells(step.frame, m),
                        to_string(m.status), motion_cells(m), m.tracked, m.inliers, speed_cells(m),
                        to_string(m.condition), m.parallax, step.milliseconds);
  }
  evaluation::write_text(file, text);
}

void write_csv(const std::filesystem::path& file, std::span<const LidarStep> steps) {
  std::string text = fmt::format(
      "frame,stamp,from,status,source,{}iterations,degenerate,seed_translation,seed_rotation,"
      "milliseconds\n",
      motion_columns);
  for (const LidarStep& step : steps) {
    const RelativeMotion& m = step.odometry;
    const LidarMotion& lidar = step.lidar;
    text += fmt::format("{},{},{}{}", stamp_cells(step.frame, m),
                        step.with_scan ? to_string(lidar.status) : "no scan",
                        m.status == OdometryStatus::ok ? to_string(m.source) : "", motion_cells(m));
    text += step.with_scan ? fmt::format(",{},{},{},{},{:.9g},{:.9g},{:.9g}\n", lidar.tracked,
                                         lidar.inliers, lidar.iterations,
                                         directions(lidar.degenerate), lidar.seed_translation_error,
                                         degrees(lidar.seed_rotation_error), step.milliseconds)
                           : ",,,,,,,\n";
  }
  evaluation::write_text(file, text);
}

}  // namespace maploop::odometry
