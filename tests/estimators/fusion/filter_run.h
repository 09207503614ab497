// These functions run the filter over recorded or synthetic measurements.
#pragma once

#include <algorithm>
#include <string_view>
#include <variant>
#include <vector>

#include "estimators/fusion/configuration.h"
#include "estimators/fusion/reduced_imu_filter.h"

namespace maploop::testing {

using Measurement = std::variant<ImuSample, RelativeMotion, GnssFix, WheelSpeed>;

inline Time available_of(const Measurement& m) {
  return std::visit([](const auto& v) { return v.available; }, m);
}
inline Time stamp_of(const Measurement& m) {
  return std::visit([](const auto& v) { return v.stamp; }, m);
}

inline fusion::Outcome add(fusion::ReducedImuFilter& filter, const Measurement& m) {
  return std::visit([&](const auto& v) { return filter.add(v); }, m);
}

template <class Samples>
void append(std::vector<Measurement>& all, const Samples& samples) {
  all.insert(all.end(), samples.begin(), samples.end());
}

inline void sort_as_available(std::vector<Measurement>& all) {
  std::stable_sort(all.begin(), all.end(), [](const Measurement& a, const Measurement& b) {
    return available_of(a) < available_of(b);
  });
}

// Returns the measurements in the order in which they become available in a real vehicle.
inline std::vector<Measurement> as_available(const std::vector<ImuSample>& imu,
                                             const std::vector<RelativeMotion>& odometry,
                                             const GnssFix& fix) {
  std::vector<Measurement> all{fix};
  append(all, imu);
  append(all, odometry);
  sort_as_available(all);
  return all;
}

inline void add_as_available(fusion::ReducedImuFilter& filter, std::vector<Measurement> all) {
  sort_as_available(all);
  for (const Measurement& m : all) add(filter, m);
}

inline fusion::FusionParameters configured(std::string_view configuration) {
  fusion::FusionParameters p;
  apply(fusion::configuration(configuration), p);
  return p;
}

inline Eigen::Isometry3d pose_of(const NavState& nav) {
  return Eigen::Translation3d(nav.position_enu) *
         Eigen::Quaterniond(rotation_enu_body(nav.attitude));
}

// Returns the state at each odometry stamp, requested as soon as that odometry has arrived.
inline std::vector<NavState> states_after_odometry(fusion::ReducedImuFilter& filter,
                                                   const std::vector<Measurement>& measurements) {
  std::vector<NavState> states;
  for (const Measurement& m : measurements) {
    add(filter, m);
    if (!std::holds_alternative<RelativeMotion>(m)) continue;
    if (const auto nav = filter.state_at(stamp_of(m))) states.push_back(*nav);
  }
  return states;
}

}  // namespace maploop::testing
