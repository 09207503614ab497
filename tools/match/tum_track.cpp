#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "msgs/frames.h"
#include "tools/match/track_file.h"

namespace maploop::match {

Track parse_tum_track(std::string_view text, std::string_view name,
                      const TrackFileOptions& options) {
  if (!options.origin)
    throw std::runtime_error(std::string(name) +
                             " is in local metres: say where their origin is (--origin LAT,LON)");
  const LocalFrame frame(*options.origin);
  Track track;
  int line_number = 0;
  while (!text.empty()) {
    ++line_number;
    const auto end = text.find('\n');
    const std::string line(text.substr(0, end));
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    if (line.empty() || line[0] == '#' || line == "\r") continue;
    double t = 0.0, x = 0.0, y = 0.0, z = 0.0, qx = 0.0, qy = 0.0, qz = 0.0, qw = 0.0;
    if (std::sscanf(line.c_str(), "%lf %lf %lf %lf %lf %lf %lf %lf", &t, &x, &y, &z, &qx, &qy, &qz,
                    &qw) != 8)
      throw std::runtime_error(std::string(name) + ":" + std::to_string(line_number) +
                               ": not 't x y z qx qy qz qw'");
    mapmatch::VehicleFix fix;
    fix.stamp = Time(from_seconds(t));
    fix.position = frame.to_geodetic({x, y, 0.0});
    fix.covariance = options.sigma * options.sigma * Eigen::Matrix2d::Identity();
    fix.azimuth =
        azimuth_from_yaw(std::atan2(2.0 * (qw * qz + qx * qy), 1.0 - 2.0 * (qy * qy + qz * qz)));
    track.push_back(fix);
  }
  return track;
}

}  // namespace maploop::match
