// These tests check that decoding the data of running live sensors does not allocate.
#include <gtest/gtest.h>

#include <cmath>

#include "sensors/gnss/nmea_fixes.h"
#include "sensors/imu/ncom.h"
#include "sensors/imu/ncom_packet.h"
#include "sensors/velodyne/velodyne_decoder.h"
#include "tests/sensors/velodyne/made_packets.h"
#include "tests/support/counted_allocations.h"

namespace maploop::sensors {
namespace {

const Time begin = parse_time("2026-03-01 10:00:00");

TEST(Allocation, TheDecodersOfLiveSensorsMakeNone) {
  if (!testing::counts_allocations()) GTEST_SKIP() << "a sanitizer owns malloc";
  VelodyneDecoder velodyne(VelodyneModel::vlp16, factory_lasers(VelodyneModel::vlp16));
  NmeaFixes gnss;
  NcomClock imu;
  LidarScan scan;
  GnssFix fix;
  int scans = 0, stamps = 0;
  const auto run = [&](int from, int to) {
    for (int i = from; i < to; ++i) {
      const auto us = static_cast<std::uint32_t>(1327.104 * i);
      const Time arrival = begin + std::chrono::microseconds(us);
      scans += velodyne.add(data_packet(std::fmod(477.757 * i, 36000.0), 39.8, us), arrival, scan);
      NcomFault fault{};
      const auto sample =
          parse_ncom(ncom_packet(static_cast<std::uint16_t>(10 * i % 60'000), {1.0}), fault);
      stamps += sample && imu.stamp(sample->minute_ms, arrival);
      gnss.add("$GNGGA,101801.00,4858.95,N,00823.42,E,1,12,0.8,115.2,M,47.9,M,,*7F", arrival, fix);
    }
  };
  run(0, 400);  // two scans and more: their buffers circulate
  const long before = testing::thread_allocations();
  const int scans_before = scans;
  run(400, 1500);
  EXPECT_EQ(testing::thread_allocations() - before, 0);
  EXPECT_GT(scans - scans_before, 10);
  EXPECT_GT(stamps, 100);
  EXPECT_EQ(gnss.counts().sentences, 1500U);
}

}  // namespace
}  // namespace maploop::sensors
