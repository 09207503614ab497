#include "sensors/cloud/scan_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "sensors/cloud/cloud_file.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

class ScanFolderTest : public ::testing::Test {
 protected:
  // One point at (x, 0, 0), or one for each of the times.
  void write(const std::string& name, float x, const std::vector<float>& times = {}) const {
    CloudTable table{{"x", "y", "z"}, {x, 0, 0}};
    if (!times.empty()) table = {{"x", "y", "z", "time"}, {}};
    for (const float time : times) table.values.insert(table.values.end(), {x, 0, 0, time});
    std::ofstream(folder_.path() / name) << encode_cloud(table, name, CloudEncoding::ascii);
  }
  std::filesystem::path text(const std::string& name, const std::string& content) const {
    std::ofstream(folder_.path() / name) << content;
    return folder_.path() / name;
  }
  std::string error(const std::filesystem::path& stamps) const {
    try {
      const ScanFolder folder(folder_.path(), stamps);
      return "";
    } catch (const std::runtime_error& e) {
      return e.what();
    }
  }
  testing::TemporaryFolder folder_;
};

TEST_F(ScanFolderTest, DeliversAllFormatsInTheNaturalOrderOfTheirNames) {
  write("scan10.ply", 10);
  write("scan9.pcd", 9);
  const std::vector<float> bin{11, 0, 0, 0.5F};
  std::ofstream(folder_.path() / "scan11.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(bin.data()), 16);
  text("readme.txt", "no scan");
  ScanFolder folder(folder_.path());
  LidarScan scan;
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(folder.next(scan));
    EXPECT_EQ(scan.points.at(0).x, static_cast<float>(9 + i));
    EXPECT_EQ(scan.sequence, i);
    EXPECT_EQ(scan.stamp, Time(from_seconds(0.1 * static_cast<double>(i))));
    EXPECT_LT(scan.start, scan.stamp);
    EXPECT_LT(scan.stamp, scan.end);
    EXPECT_TRUE(scan.times.empty());
  }
  EXPECT_FALSE(folder.next(scan));
  EXPECT_NE(folder.remarks().find("0.1 s apart"), std::string::npos);
  EXPECT_NE(folder.remarks().find("not corrected"), std::string::npos);
  EXPECT_TRUE(ScanFolder::is(folder_.path()));
  EXPECT_FALSE(ScanFolder::is(folder_.path() / "scan9.pcd"));
}

TEST_F(ScanFolderTest, LeavesAScanOutThatCannotBeReadAndSaysWhy) {
  write("1.pcd", 1);
  text("2.pcd", "nonsense");
  write("3.pcd", 3);
  ScanFolder folder(folder_.path());
  LidarScan scan;
  ASSERT_TRUE(folder.next(scan));
  ASSERT_TRUE(folder.next(scan));
  EXPECT_EQ(scan.sequence, 2U);
  EXPECT_EQ(folder.report().refused, 1U);
  EXPECT_NE(folder.remarks().find("2.pcd: left out: line 1: neither a PCD"), std::string::npos)
      << folder.remarks();
}

TEST_F(ScanFolderTest, TimesAreSecondsFromTheirMiddleWhateverTheirUnitAndStart) {
  write("1.pcd", 1, {0.0F, 0.02F, 0.1F});      // s
  write("2.pcd", 2, {1e8F, 1.2e8F, 2e8F});     // ns
  write("3.pcd", 3, {-50.0F, -30.0F, 50.0F});  // ms
  write("4.pcd", 4, {7.0F, 7.0F, 7.0F});       // corrected by another program
  write("5.pcd", 5, {0.0F, 1e-7F, 1e-6F});     // no scan
  ScanFolder folder(folder_.path());
  LidarScan scan;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(folder.next(scan));
    ASSERT_EQ(scan.times.size(), 3U);
    EXPECT_NEAR(scan.times[0], -0.05F, 1e-6F);
    EXPECT_NEAR(scan.times[1], -0.03F, 1e-6F);
    EXPECT_NEAR(scan.times[2], 0.05F, 1e-6F);
    EXPECT_NEAR(to_seconds(scan.end - scan.start), 0.1, 1e-6);
  }
  ASSERT_TRUE(folder.next(scan));
  EXPECT_TRUE(scan.times.empty());
  EXPECT_FALSE(folder.next(scan));
  EXPECT_NE(folder.remarks().find("which is no scan of 0.5 to 500 ms"), std::string::npos);
}

TEST_F(ScanFolderTest, StampsAreSecondsOrDatesOfTheNamedFileOrTheFolders) {
  write("1.pcd", 1);
  write("2.pcd", 2);
  LidarScan scan;
  ScanFolder named(folder_.path(), text("seconds", "3.5\n4.25\n"));
  ASSERT_TRUE(named.next(scan));
  EXPECT_EQ(scan.stamp, Time(from_seconds(3.5)));
  text("timestamps.txt", "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.067\n");
  ScanFolder beside(folder_.path());
  ASSERT_TRUE(beside.next(scan));
  EXPECT_EQ(scan.stamp, parse_time("2011-09-26 13:02:25.964389445"));
  EXPECT_EQ(beside.remarks().find("0.1 s apart"), std::string::npos);

  EXPECT_NE(error(text("few", "1\n")).find("has 2 scans (.pcd, .ply, .bin), but"),
            std::string::npos);
  EXPECT_NE(error(text("back", "2\n1\n")).find("back:2: the stamps do not increase"),
            std::string::npos);
  EXPECT_NE(error(text("words", "1\ntwo\n")).find("words:2: 'two' is neither seconds"),
            std::string::npos);
  EXPECT_NE(error(text("far", "1\n1e300\n")).find("far:2:"), std::string::npos);
}

TEST_F(ScanFolderTest, AFolderWithoutAScanIsRefused) {
  EXPECT_NE(error({}).find("has 0 scans"), std::string::npos) << error({});
}

}  // namespace
}  // namespace maploop::sensors
