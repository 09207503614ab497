#include "tools/odometry/lidar_csv.h"

#include <array>
#include <iomanip>
#include <sstream>
#include <string>

#include "msgs/frames.h"
#include "tools/evaluation/text_file.h"

namespace maploop::odometry {
namespace {

constexpr std::array<std::string_view, odometry_source_count> sources{"visual", "lidar",
                                                                      "visual-lidar"};

std::string directions(std::uint8_t bits) {
  std::string names;
  for (unsigned i = 0; i < 6; ++i) {
    if ((bits >> i & 1u) == 0) continue;
    names.append(names.empty() ? "" : "+").append(to_string(static_cast<MotionDirection>(i)));
  }
  return names;
}

void write_motion(std::ostream& out, const RelativeMotion& m) {
  if (m.status != OdometryStatus::ok) {
    out << std::string(12, ',');
    return;
  }
  const Eigen::AngleAxisd turn(m.rotation);
  const Eigen::Vector3d rotation = turn.angle() * turn.axis();
  const Eigen::Matrix<double, 6, 1> sigma = m.covariance.diagonal().cwiseSqrt();
  for (int i = 0; i < 3; ++i) out << ',' << m.translation[i];
  for (int i = 0; i < 3; ++i) out << ',' << degrees(rotation[i]);
  for (int i = 0; i < 3; ++i) out << ',' << sigma[i];
  for (int i = 3; i < 6; ++i) out << ',' << degrees(sigma[i]);
}

}  // namespace

void write_lidar_csv(const std::filesystem::path& file, std::span<const LidarStep> steps) {
  std::ostringstream out;
  out << "frame,stamp,from,status,source,x,y,z,rx,ry,rz,sigma_x,sigma_y,sigma_z,sigma_rx,sigma_ry,"
         "sigma_rz,tracked,inliers,iterations,degenerate,seed_translation,seed_rotation,"
         "milliseconds\n";
  const auto seconds = [](Time t) { return static_cast<double>(to_nanoseconds(t)) * 1e-9; };
  for (const LidarStep& step : steps) {
    const RelativeMotion& m = step.odometry;
    const bool ok = m.status == OdometryStatus::ok;
    out << step.frame << ',' << std::fixed << std::setprecision(6) << seconds(m.stamp) << ',';
    if (ok) out << seconds(m.from);
    out << ',' << (step.with_scan ? to_string(step.lidar.status) : "no scan") << ','
        << (ok ? sources[static_cast<std::size_t>(m.source)] : "") << std::defaultfloat
        << std::setprecision(9);
    write_motion(out, m);
    if (step.with_scan) {
      out << ',' << step.lidar.tracked << ',' << step.lidar.inliers << ',' << step.lidar.iterations
          << ',' << directions(step.lidar.degenerate) << ',' << step.lidar.seed_translation_error
          << ',' << degrees(step.lidar.seed_rotation_error) << ',' << step.milliseconds << '\n';
    } else {
      out << ",,,,,,,\n";
    }
  }
  evaluation::write_text(file, out.str());
}

}  // namespace maploop::odometry
