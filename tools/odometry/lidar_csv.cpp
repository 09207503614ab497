#include "tools/odometry/lidar_csv.h"

#include <fmt/format.h>

#include <string>

#include "msgs/frames.h"
#include "tools/evaluate/text_file.h"
#include "tools/odometry/motion_csv.h"

namespace maploop::odometry {
namespace {

std::string directions(std::uint8_t bits) {
  std::string names;
  for (unsigned i = 0; i < 6; ++i) {
    if ((bits >> i & 1u) == 0) continue;
    names.append(names.empty() ? "" : "+").append(to_string(static_cast<MotionDirection>(i)));
  }
  return names;
}

}  // namespace

void write_lidar_csv(const std::filesystem::path& file, std::span<const LidarStep> steps) {
  std::string text =
      "frame,stamp,from,status,source,x,y,z,rx,ry,rz,sigma_x,sigma_y,sigma_z,sigma_rx,sigma_ry,"
      "sigma_rz,tracked,inliers,iterations,degenerate,seed_translation,seed_rotation,"
      "milliseconds\n";
  for (const LidarStep& step : steps) {
    const RelativeMotion& m = step.odometry;
    const LidarMotion& lidar = step.lidar;
    text += fmt::format(
        "{},{},{}{}", stamp_cells(step.frame, m),
        step.with_scan ? to_string(lidar.status) : "no scan",
        m.status == OdometryStatus::ok ? to_string(m.source) : "",
        motion_cells(m));
    text += step.with_scan ? fmt::format(",{},{},{},{},{:.9g},{:.9g},{:.9g}\n", lidar.tracked,
                                         lidar.inliers, lidar.iterations,
                                         directions(lidar.degenerate), lidar.seed_translation_error,
                                         degrees(lidar.seed_rotation_error), step.milliseconds)
                           : ",,,,,,,\n";
  }
  evaluation::write_text(file, text);
}

}  // namespace maploop::odometry
