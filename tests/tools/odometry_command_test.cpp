// `maploop odometry` and `maploop evaluate` as their users run them.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/real_data.h"
#include "tools/evaluation/kitti_poses.h"

namespace maploop {
namespace {

using testing::ProcessResult;
using testing::TemporaryFolder;

ProcessResult maploop(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), MAPLOOP_COMMAND);
  return testing::run(arguments);
}

std::size_t lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::size_t count = 0;
  for (std::string line; std::getline(in, line);) ++count;
  return count;
}

TEST(OdometryCommand, AloneOnADriveIsWithinAPercentOfTheTruth) {
  MAPLOOP_REQUIRE_DRIVE();
  MAPLOOP_REQUIRE_REAL_DATA();
  const TemporaryFolder folder;
  const std::string poses = (folder.path() / "poses.txt").string();
  const std::string csv = (folder.path() / "motions.csv").string();
  const ProcessResult run =
      maploop({"odometry", testing::drive_0013().string(), "--poses", poses, "--csv", csv});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(evaluation::read_kitti_poses(poses).size(), 144u);
  EXPECT_EQ(lines_of(csv), 145u);

  const std::string json = (folder.path() / "score.json").string();
  const std::string html = (folder.path() / "score.html").string();
  const auto truth = testing::real_data() / "kitti/drive_0013_truth/velocity_integrated.txt";
  const ProcessResult score = maploop(
      {"evaluate", poses, truth.string(), "--lengths", "100", "--json", json, "--html", html});
  ASSERT_EQ(score.status, 0) << score.error;
  const auto result = nlohmann::json::parse(std::ifstream(json));
  EXPECT_EQ(result["frames"], 144);
  EXPECT_LT(result["lengths"][0]["common_rotation_removed"]["percent"], 0.6);
  EXPECT_GT(lines_of(html), 50u);
}

TEST(OdometryCommand, FirstAndLastNameTheFrames) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const TemporaryFolder folder;
  const std::string tum = (folder.path() / "tum.txt").string();
  const auto tracks = testing::real_data() / "kitti_odometry/tracks/2011_09_26_drive_0001.csv.gz";
  const ProcessResult run =
      maploop({"odometry", tracks.string(), "--first", "20", "--last", "29", "--tum", tum});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(lines_of(tum), 10u);
  EXPECT_NE(run.out.find("frames 20 to 29"), std::string::npos) << run.out;
  EXPECT_EQ(maploop({"odometry", tracks.string(), "--first", "9000"}).status, 1);
}

TEST(EvaluateCommand, TrajectoriesWithoutACommonMomentAreRefusedWithTheRemedy) {
  const TemporaryFolder folder;
  for (const std::string name : {"a", "b"}) {
    std::ofstream out(folder.path() / name);
    for (int i = 0; i < 5; ++i)
      out << (name == "a" ? 0 : 100) + i << ".0 0 0 " << i << " 0 0 0 1\n";
  }
  const ProcessResult run =
      maploop({"evaluate", (folder.path() / "a").string(), (folder.path() / "b").string()});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.error.find("--max-difference"), std::string::npos) << run.error;
}

}  // namespace
}  // namespace maploop
