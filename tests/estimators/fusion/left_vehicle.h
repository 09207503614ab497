// Vehicles that were left standing or driving, for tests of what a filter makes of the last place.
#pragma once

#include <cmath>
#include <cstdint>
#include <variant>
#include <vector>

#include "estimators/fusion/last_place.h"
#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::testing::left_vehicle {

using namespace maploop::fusion;

// Returns the vehicle's true place at `t`, as well known as a filter with fixes knows it.
inline LastPlace place_at(const SyntheticDrive& drive, double t) {
  LastPlace place;
  place.stamp = SyntheticDrive::at(t);
  place.position = LocalFrame(test_origin()).to_geodetic(drive.pose(t).translation());
  place.attitude = {drive.azimuth(t), drive.pitch(t), drive.roll(t)};
  place.speed = drive.speed(t);
  place.position_sigma = {1.0, 1.0, 2.0};
  place.azimuth_sigma = radians(0.5);
  place.tilt_sigma = radians(0.5);
  place.speed_sigma = 0.1;
  return place;
}

// Stands for 10 s, and drives off.
inline SyntheticDrive standing() {
  MotionProfile profile;
  profile.speed = [](double t) { return t < 10.0 ? 0.0 : 1.5 * (t - 10.0); };
  profile.azimuth = -1.2;
  return {profile, 20.0, test_origin()};
}

inline SyntheticDrive driving() {
  MotionProfile profile;
  profile.yaw_rate = [](double t) { return 0.1 * std::sin(t); };
  profile.azimuth = 0.7;
  return {profile, 20.0, test_origin()};
}

inline std::vector<Measurement> measured(const SyntheticDrive& drive, double from, double to,
                                         bool fixes = true) {
  std::vector<Measurement> all, part;
  append(all, drive.imu(100.0));
  append(all, drive.wheels(0.0, 20.0));
  for (int i = 0; fixes && i < 20; ++i) {
    all.push_back(drive.fix(i));
    std::get<GnssFix>(all.back()).sequence = static_cast<std::uint64_t>(i);
  }
  for (const Measurement& m : all) {
    const Time t = stamp_of(m);
    if (t >= SyntheticDrive::at(from) && t < SyntheticDrive::at(to)) part.push_back(m);
  }
  sort_as_available(part);
  return part;
}

}  // namespace maploop::testing::left_vehicle
