#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "sensors/replay/packed_scan.h"
#include "sensors/replay/velodyne_source.h"

namespace maploop::sensors {
namespace {

std::vector<char> bytes_of(const std::vector<LidarPoint>& points) {
  std::vector<char> bytes(points.size() * sizeof(LidarPoint));
  std::memcpy(bytes.data(), points.data(), bytes.size());
  return bytes;
}

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

TEST(VelodynePoints, KeepsOrderAndDropsEveryPointWithAValueThatIsNotFinite) {
  const auto bytes = bytes_of({{1, 2, 3, 0.5F},
                               {nan, 0, 0, 0},
                               {0, inf, 0, 0},
                               {4, 5, 6, 0.25F},
                               {0, 0, -inf, 0},
                               {0, 0, 0, nan}});
  std::vector<LidarPoint> points;
  EXPECT_EQ(parse_velodyne_points(bytes, points), 4U);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].z, 3.0F);
  EXPECT_EQ(points[1].x, 4.0F);
  EXPECT_EQ(points[1].reflectance, 0.25F);
}

TEST(VelodynePoints, RefusesEmptyCutAndWhollyBadScans) {
  std::vector<LidarPoint> points;
  auto bytes = bytes_of({{1, 2, 3, 0.5F}, {1, 2, 3, 0.5F}});
  EXPECT_THROW(parse_velodyne_points({}, points), std::runtime_error);
  EXPECT_THROW(parse_velodyne_points(bytes_of({{nan, nan, nan, nan}}), points), std::runtime_error);
  bytes.pop_back();
  EXPECT_THROW(parse_velodyne_points(bytes, points), std::runtime_error);
}

TEST(VelodynePoints, ReusesTheBuffer) {
  std::vector<LidarPoint> points;
  parse_velodyne_points(bytes_of(std::vector<LidarPoint>(100, {1, 2, 3, 0})), points);
  const LidarPoint* buffer = points.data();
  parse_velodyne_points(bytes_of(std::vector<LidarPoint>(7, {1, 2, 3, 0})), points);
  EXPECT_EQ(points.size(), 7U);
  parse_velodyne_points(bytes_of(std::vector<LidarPoint>(100, {1, 2, 3, 0})), points);
  EXPECT_EQ(points.data(), buffer);
}

// Returns ranges of every size, with no return for a fifth of them.
RangeImage a_turn() {
  RangeImage image;
  image.elevations = {0.1F, 0.0F, -0.2F};
  image.firings = 501;
  image.first_azimuth = 3.0;
  image.azimuth_step = -0.01;
  std::mt19937 random(1);
  for (std::size_t i = 0; i < 3 * image.firings; ++i) {
    image.ranges.push_back(random() % 5 == 0 ? 0 : static_cast<std::uint16_t>(random() % 65536));
    image.reflectances.push_back(
        static_cast<std::uint8_t>(image.ranges.back() == 0 ? 0 : random() % 100));
  }
  return image;
}

std::vector<char> packed_turn() {
  const std::string text = pack_scan(a_turn());
  return {text.begin(), text.end()};
}

TEST(PackedScan, GivesBackWhatWasPackedAndItsPoints) {
  const RangeImage image = a_turn();
  RangeImage back;
  std::vector<LidarPoint> points, expected;
  unpack_scan(packed_turn(), back, points);
  EXPECT_EQ(back.elevations, image.elevations);
  EXPECT_EQ(back.ranges, image.ranges);
  EXPECT_EQ(back.reflectances, image.reflectances);
  points_of(image, expected);
  ASSERT_EQ(points.size(), expected.size());
  std::size_t at = 0, i = 0;
  while (image.ranges[i] == 0) ++i;
  const LidarPoint& p = points[at];
  EXPECT_EQ(p.x, expected[at].x);
  EXPECT_NEAR(std::hypot(p.x, p.y, p.z), 0.002 * image.ranges[i], 1e-4);
  EXPECT_NEAR(std::atan2(p.y, p.x), 3.0 - 0.01 * static_cast<double>(i), 1e-5);
  EXPECT_NEAR(std::atan2(p.z, std::hypot(p.x, p.y)), 0.1, 1e-5);
}

TEST(PackedScan, CutAndDamagedOnesAreRefused) {
  const std::vector<char> whole = packed_turn();
  RangeImage image;
  std::vector<LidarPoint> points;
  for (std::size_t size = 0; size < whole.size(); size += 37)
    EXPECT_THROW(unpack_scan({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)},
                             image, points),
                 std::runtime_error)
        << size;
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    std::vector<char> damaged = whole;
    damaged[random() % damaged.size()] = static_cast<char>(random());
    try {
      unpack_scan(damaged, image, points);
      EXPECT_LE(points.size(), image.ranges.size());
    } catch (const std::runtime_error&) {
    }
  }
}

}  // namespace
}  // namespace maploop::sensors
