#include "tools/odometry/motion_csv.h"

#include <cmath>
#include <iomanip>
#include <sstream>

#include "msgs/frames.h"
#include "tools/evaluation/text_file.h"

namespace maploop::odometry {
namespace {

void write_pose(std::ostream& out, const RelativeMotion& m) {
  const Eigen::AngleAxisd turn(m.rotation);
  const Eigen::Vector3d rotation = turn.angle() * turn.axis();
  const Eigen::Matrix<double, 6, 1> sigma = m.covariance.diagonal().cwiseSqrt();
  for (int i = 0; i < 3; ++i) out << ',' << m.translation[i];
  for (int i = 0; i < 3; ++i) out << ',' << degrees(rotation[i]);
  for (int i = 0; i < 3; ++i) out << ',' << sigma[i];
  for (int i = 3; i < 6; ++i) out << ',' << degrees(sigma[i]);
}

void write_speed(std::ostream& out, const RelativeMotion& m) {
  const double seconds = to_seconds(m.stamp - m.from);
  const Eigen::Matrix3d R = m.rotation.toRotationMatrix();
  out << ',' << m.translation.x() / seconds << ',' << std::sqrt(m.covariance(0, 0)) / seconds << ','
      << -degrees(std::atan2(R(1, 0), R(0, 0))) << ',' << degrees(std::sqrt(m.covariance(5, 5)));
}

}  // namespace

void write_csv(const std::filesystem::path& file, std::span<const Step> steps) {
  std::ostringstream out;
  out << "frame,stamp,from,status,x,y,z,rx,ry,rz,sigma_x,sigma_y,sigma_z,sigma_rx,sigma_ry,"
         "sigma_rz,tracked,inliers,forward_speed,sigma_forward_speed,azimuth_increment,"
         "sigma_azimuth_increment,condition,parallax,milliseconds\n";
  const auto seconds = [](Time t) { return static_cast<double>(to_nanoseconds(t)) * 1e-9; };
  for (const Step& step : steps) {
    const RelativeMotion& m = step.motion;
    const bool ok = m.status == OdometryStatus::ok;
    out << step.frame << ',' << std::fixed << std::setprecision(6) << seconds(m.stamp) << ',';
    if (ok) out << seconds(m.from);
    out << ',' << to_string(m.status) << std::defaultfloat << std::setprecision(9);
    if (ok) {
      write_pose(out, m);
    } else {
      out << std::string(12, ',');
    }
    out << ',' << m.tracked << ',' << m.inliers;
    if (ok) {
      write_speed(out, m);
    } else {
      out << std::string(4, ',');
    }
    out << ',' << to_string(m.condition) << ',' << m.parallax << ',' << step.milliseconds << '\n';
  }
  evaluation::write_text(file, out.str());
}

}  // namespace maploop::odometry
