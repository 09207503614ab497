// Clouds are exchanged with PCL: by files in both directions, and in memory by the adapter.
#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "msgs/named_enum.h"
#include "sensors/cloud/cloud_file.h"
#include "sensors/cloud/pcl_adapter.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZI>;

LidarScan some_scan() {
  LidarScan scan;
  scan.stamp = parse_time("2011-09-26 13:02:25.964389");
  scan.sequence = 7;
  for (int i = 0; i < 3000; ++i) {
    const auto k = static_cast<float>(i);
    scan.points.push_back({0.37F * k, -k / 3.0F, 1e-3F * k * k, k / 3000.0F});
  }
  return scan;
}

bool same(const LidarPoint& ours, const pcl::PointXYZI& theirs) {
  return ours.x == theirs.x && ours.y == theirs.y && ours.z == theirs.z &&
         ours.reflectance == theirs.intensity;
}

class PclFiles : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  testing::TemporaryFolder folder_;
  LidarScan scan_ = some_scan();
};

TEST_F(PclFiles, PclReadsOurFiles) {
  CloudTable table{{"x", "y", "z", "intensity"}, {}};
  for (const LidarPoint& p : scan_.points)
    table.values.insert(table.values.end(), {p.x, p.y, p.z, p.reflectance});
  using enum CloudEncoding;
  for (const char* name : {"a.pcd", "a.ply"}) {
    for (const CloudEncoding encoding : {ascii, binary, compressed}) {
      const bool ply = name == std::string("a.ply");
      if (ply && encoding == compressed) continue;
      std::ofstream(path(name), std::ios::binary) << encode_cloud(table, name, encoding);
      Cloud cloud;
      ASSERT_EQ(
          ply ? pcl::io::loadPLYFile(path(name), cloud) : pcl::io::loadPCDFile(path(name), cloud),
          0);
      ASSERT_EQ(cloud.size(), scan_.points.size());
      for (std::size_t i = 0; i < cloud.size(); ++i)
        ASSERT_TRUE(same(scan_.points[i], cloud[i])) << name << ' ' << to_string(encoding) << i;
    }
  }
}

TEST_F(PclFiles, WeReadPclsFiles) {
  Cloud cloud = to_pcl<Cloud>(scan_);
  cloud.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0, 0});
  cloud.is_dense = false;
  pcl::io::savePCDFileASCII(path("ascii.pcd"), cloud);
  pcl::io::savePCDFileBinary(path("binary.pcd"), cloud);
  pcl::io::savePCDFileBinaryCompressed(path("compressed.pcd"), cloud);
  pcl::io::savePLYFileASCII(path("ascii.ply"), cloud);
  pcl::io::savePLYFileBinary(path("binary.ply"), cloud);
  for (const char* name :
       {"ascii.pcd", "binary.pcd", "compressed.pcd", "ascii.ply", "binary.ply"}) {
    const auto read = read_cloud(path(name));
    ASSERT_EQ(read.points.size(), scan_.points.size()) << name;
    // PCL writes eight digits of a PCD's numbers and six of a PLY's.
    const bool exact = name[0] != 'a';
    for (std::size_t i = 0; i < read.points.size(); ++i) {
      ASSERT_TRUE(!exact || same(read.points[i], cloud[i])) << name << i;
      ASSERT_NEAR(read.points[i].z, cloud[i].z, 2e-5F * std::max(1.0F, cloud[i].z)) << name << i;
    }
  }
}

TEST(PclAdapter, AScanComesBackFromPclAsItWas) {
  const LidarScan scan = some_scan();
  const auto cloud = to_pcl<Cloud>(scan);
  EXPECT_EQ(cloud.header.frame_id, "velo");
  EXPECT_EQ(cloud.width, scan.points.size());
  LidarScan back;
  from_pcl(cloud, back);
  EXPECT_EQ(back.stamp, scan.stamp);
  EXPECT_EQ(back.sequence, scan.sequence);
  ASSERT_EQ(back.points.size(), scan.points.size());
  EXPECT_EQ(
      std::memcmp(back.points.data(), scan.points.data(), scan.points.size() * sizeof(LidarPoint)),
      0);
}

TEST(PclAdapter, PointsWithoutIntensityHaveNoReflectanceAndMissingReturnsAreDropped) {
  auto cloud = to_pcl<pcl::PointCloud<pcl::PointXYZ>>(some_scan());
  cloud[0].y = std::numeric_limits<float>::infinity();
  LidarScan back;
  from_pcl(cloud, back);
  ASSERT_EQ(back.points.size(), cloud.size() - 1);
  EXPECT_EQ(back.points[0].x, cloud[1].x);
  EXPECT_EQ(back.points[9].reflectance, 0.0F);
  EXPECT_LT(back.start, back.stamp);
  EXPECT_LT(back.stamp, back.end);
}

}  // namespace
}  // namespace maploop::sensors
