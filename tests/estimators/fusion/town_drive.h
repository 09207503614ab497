// A drive through a town, with the fixes of a receiver, for tests of the filter's aids.
#pragma once

#include <cmath>
#include <random>

#include "msgs/nav_state.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::testing::town_drive {

inline MotionProfile town() {
  MotionProfile profile;
  profile.speed = [](double t) { return 8.0 + 5.0 * std::sin(t / 7.0); };
  profile.yaw_rate = [](double t) { return 0.35 * std::pow(std::sin(t / 9.0), 5); };
  profile.azimuth = 0.8;
  return profile;
}

inline GnssFix fix(const SyntheticDrive& drive, double t, std::mt19937* random = nullptr) {
  GnssFix f = drive.fix(t);
  f.available = f.stamp + from_seconds(0.1);
  f.sequence = static_cast<std::uint64_t>(std::llround(t));
  if (random != nullptr) {
    std::normal_distribution<double> normal;
    const LocalFrame frame(test_origin());
    Eigen::Vector3d shift;
    for (double& s : shift) s = normal(*random);
    f.position = frame.to_geodetic(frame.to_enu(f.position) + shift);
    for (double& v : f.velocity_enu) v += 0.1 * normal(*random);
  }
  return f;
}

inline double horizontal_error(const NavState& nav, const SyntheticDrive& drive, double t) {
  return (nav.position_enu - drive.pose(t).translation()).head<2>().norm();
}

}  // namespace maploop::testing::town_drive
