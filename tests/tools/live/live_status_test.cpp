// Tests the line that reports which sensors deliver data.
#include "tools/live/live_status.h"

#include <gtest/gtest.h>

namespace maploop::tools {
namespace {

Health health_at(double elapsed, std::uint64_t imu, std::uint64_t camera) {
  Health health;
  health.elapsed = elapsed;
  health.sensors.resize(2);
  health.sensors[0].name = "imu";
  health.sensors[0].delivered = imu;
  health.sensors[1].name = "camera";
  health.sensors[1].delivered = camera;
  return health;
}

TEST(LiveStatus, SaysRatesAndWhoIsAbsent) {
  LiveStatus status;
  EXPECT_EQ(status.text(), "");
  status.take(health_at(1.0, 100, 0));
  EXPECT_EQ(status.text(), "camera absent, imu 100.0 Hz");
  status.take(health_at(2.0, 150, 10));
  EXPECT_EQ(status.text(), "camera 5.0 Hz, imu 75.0 Hz");
}

TEST(LiveStatus, ASensorThatWasLostIsAbsent) {
  LiveStatus status;
  for (int second = 1; second <= 10; ++second) status.take(health_at(second, 100, second));
  EXPECT_EQ(status.text(), "camera 1.0 Hz, imu absent");
}

TEST(LiveStatus, NothingCameWhereNoSensorDelivered) {
  EXPECT_TRUE(nothing_came(health_at(1.0, 0, 0)));
  EXPECT_FALSE(nothing_came(health_at(1.0, 0, 1)));
}

}  // namespace
}  // namespace maploop::tools
