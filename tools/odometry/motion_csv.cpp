#include "tools/odometry/motion_csv.h"

#include <fmt/format.h>

#include <cmath>

#include "msgs/frames.h"
#include "tools/evaluate/text_file.h"

namespace maploop::odometry {
namespace {

std::string speed_cells(const RelativeMotion& m) {
  if (m.status != OdometryStatus::ok) return std::string(4, ',');
  const double seconds = to_seconds(m.stamp - m.from);
  const Eigen::Matrix3d R = m.rotation.toRotationMatrix();
  return fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g}", m.translation.x() / seconds,
                     std::sqrt(m.covariance(0, 0)) / seconds,
                     -degrees(std::atan2(R(1, 0), R(0, 0))),
                     degrees(std::sqrt(m.covariance(5, 5))));
}

}  // namespace

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

void write_csv(const std::filesystem::path& file, std::span<const Step> steps) {
  std::string text =
      "frame,stamp,from,status,x,y,z,rx,ry,rz,sigma_x,sigma_y,sigma_z,sigma_rx,sigma_ry,"
      "sigma_rz,tracked,inliers,forward_speed,sigma_forward_speed,azimuth_increment,"
      "sigma_azimuth_increment,condition,parallax,milliseconds\n";
  for (const Step& step : steps) {
    const RelativeMotion& m = step.motion;
    text += fmt::format("{},{}{},{},{}{},{},{:.9g},{:.9g}\n", stamp_cells(step.frame, m),
                        to_string(m.status), motion_cells(m), m.tracked, m.inliers, speed_cells(m),
                        to_string(m.condition), m.parallax, step.milliseconds);
  }
  evaluation::write_text(file, text);
}

}  // namespace maploop::odometry
