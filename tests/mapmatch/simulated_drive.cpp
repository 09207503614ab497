#include "tests/mapmatch/simulated_drive.h"

#include <cmath>

#include "tests/mapmatch/small_map.h"

namespace maploop::testing {

std::vector<mapmatch::VehicleFix> drive(const std::vector<Eigen::Vector2d>& places, double speed,
                                        double rate, double right) {
  std::vector<mapmatch::VehicleFix> fixes;
  double from = 0.0;  // m into the leg
  int count = 0;
  for (std::size_t leg = 0; leg + 1 < places.size(); ++leg) {
    const Eigen::Vector2d step = places[leg + 1] - places[leg];
    const Eigen::Vector2d u = step.normalized();
    for (; from < step.norm(); from += speed / rate) {
      const Eigen::Vector2d p = places[leg] + from * u + right * Eigen::Vector2d(u.y(), -u.x());
      mapmatch::VehicleFix fix;
      fix.stamp = Time(from_seconds(1000.0 + count++ / rate));
      fix.position = SmallMap::place(p.x(), p.y());
      fix.covariance = Eigen::Matrix2d::Identity();
      fix.speed = speed;
      fix.azimuth = std::atan2(u.x(), u.y());
      fixes.push_back(fix);
    }
    from -= step.norm();
  }
  return fixes;
}

}  // namespace maploop::testing
