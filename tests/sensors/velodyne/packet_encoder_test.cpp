// These tests encode a recorded turn as packets, and decode it again.
#include "sensors/velodyne/packet_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <tuple>
#include <vector>

#include "msgs/frames.h"
#include "sensors/replay/velodyne_source.h"
#include "sensors/velodyne/velodyne_decoder.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

const Time before_the_hour = parse_time("2026-03-01 10:59:59.95");

LidarScan recorded_scan() {
  std::ifstream file(testing::drive_0013() / "velodyne_points/data/0000000060.bin",
                     std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  LidarScan scan;
  parse_velodyne_points(bytes, scan.points);
  return scan;
}

TEST(PacketEncoder, FindsTheLasersOfARecordedScan) {
  MAPLOOP_REQUIRE_DRIVE();
  const auto lasers = fit_lasers(recorded_scan().points);
  ASSERT_TRUE(lasers);
  EXPECT_NEAR(degrees(lasers->front().elevation), 1.94, 0.01);
  EXPECT_NEAR(degrees(lasers->back().elevation), -25.0, 0.01);
  EXPECT_NEAR(lasers->front().vertical_offset, 0.209, 0.001);
  EXPECT_NEAR(lasers->back().vertical_offset, 0.105, 0.001);
}

TEST(PacketEncoder, RefusesPointsInAnotherOrder) {
  MAPLOOP_REQUIRE_DRIVE();
  LidarScan scan = recorded_scan();
  std::reverse(scan.points.begin(), scan.points.end());
  EXPECT_FALSE(fit_lasers(scan.points));
  scan.points.resize(1000);
  EXPECT_FALSE(fit_lasers(scan.points));
  EXPECT_FALSE(fit_lasers({}));
}

// Two turns of the same points are encoded; the second one, decoded, has them at their old places.
TEST(PacketEncoder, IsTheDecoderTheOtherWayRound) {
  MAPLOOP_REQUIRE_DRIVE();
  LidarScan scan = recorded_scan();
  const auto lasers = fit_lasers(scan.points);
  ASSERT_TRUE(lasers);
  const testing::TemporaryFolder folder;
  const auto calibration = folder.path() / "db.xml";
  write_velodyne_calibration(calibration, *lasers);
  VelodyneDecoder decoder(VelodyneModel::hdl64e,
                          read_velodyne_calibration(calibration, VelodyneModel::hdl64e));
  Hdl64Encoder encoder(*lasers);
  EncodedTurn turn;
  LidarScan decoded;
  int turns = 0;
  const Duration lasts = std::chrono::microseconds(103'500);
  for (int i = 0; i < 4; ++i) {
    scan.start = before_the_hour + i * lasts;
    scan.end = scan.start + lasts;
    encoder.encode(scan, turn);
    EXPECT_EQ(turn.points + turn.crowded, scan.points.size());
    EXPECT_LT(turn.crowded, scan.points.size() / 13);  // 7.0 %
    ASSERT_EQ(turn.packets.size(), 359u);
    for (const TimedPacket& packet : turn.packets) {
      const Time arrival = packet.first_firing + std::chrono::microseconds(300);
      turns += decoder.add(packet.bytes, arrival, decoded);
    }
  }
  EXPECT_EQ(decoder.counts().lost, 0u);
  EXPECT_EQ(decoder.counts().late, 0u);
  ASSERT_EQ(turns, 2);  // the first one began midway, the last one is not ended
  EXPECT_NEAR(to_seconds(decoded.start - (before_the_hour + 2 * lasts)), 0.0, 1e-3);
  EXPECT_NEAR(to_seconds(decoded.stamp - decoded.start), 0.0517, 1e-3);
  EXPECT_NEAR(static_cast<double>(decoded.points.size()), static_cast<double>(turn.points), 100.0);

  // The sums are the same, and each decoded point is near an original one by distance, height and a
  // grid of azimuths.
  const auto cell = [](const LidarPoint& p) {
    const double azimuth = std::atan2(p.y, p.x);
    return std::tuple(std::lround(azimuth / radians(0.2)), std::lround(std::hypot(p.x, p.y) / 0.02),
                      std::lround(p.z / 0.02));
  };
  std::set<std::tuple<long, long, long>> there;
  for (const LidarPoint& p : scan.points) there.insert(cell(p));
  std::size_t near = 0;
  for (const LidarPoint& p : decoded.points) {
    const auto [a, d, z] = cell(p);
    bool found = false;
    for (long i = -1; i <= 1; ++i) {
      for (long j = -1; j <= 1; ++j) {
        for (long k = -1; k <= 1; ++k) found |= there.contains({a + i, d + j, z + k});
      }
    }
    near += found;
  }
  EXPECT_GT(static_cast<double>(near), 0.999 * static_cast<double>(decoded.points.size()));
}

}  // namespace
}  // namespace maploop::sensors
