#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

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

}  // namespace
}  // namespace maploop::sensors
