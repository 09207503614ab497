// The fused filter without threads: dead reckoning for a second, from a fix on the way.
#include <cmath>
#include <iostream>

#include "estimators/fusion/reduced_imu_filter.h"

int main() {
  using namespace maploop;
  fusion::ReducedImuFilter filter{fusion::FusionParameters{}};
  const Time start = from_nanoseconds(1'000'000'000);

  GnssFix fix;
  fix.stamp = fix.available = fix.velocity_stamp = start;
  fix.position = {radians(49.0), radians(8.4), 100.0};
  fix.position_covariance.setIdentity();
  fix.velocity_enu = {0.0, 10.0, 0.0};  // north
  fix.velocity_covariance = 0.01 * Eigen::Matrix3d::Identity();
  filter.add(fix);
  for (int i = 0; i <= 100; ++i) {
    ImuSample sample;
    sample.stamp = sample.available = start + from_seconds(0.01 * i);
    sample.sequence = static_cast<std::uint64_t>(i);
    filter.add(sample);
  }
  const auto state = filter.state_at(start + from_seconds(1.0));
  if (!state) {
    std::cerr << "the filter has not started\n";
    return 1;
  }
  std::cout << state->position_enu.y() << " m north\n";
  return std::abs(state->position_enu.y() - 10.0) < 0.5 ? 0 : 1;
}
