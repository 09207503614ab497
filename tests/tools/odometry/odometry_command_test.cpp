// Tests `maploop odometry` and `maploop evaluate` as users run them.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/real_data.h"
#include "tools/evaluate/trajectory_file.h"

namespace maploop {
namespace {

using testing::ProcessResult;
using testing::TemporaryFolder;

ProcessResult maploop(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), testing::maploop_command());
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
  std::stringstream page;
  page << std::ifstream(html).rdbuf();
  EXPECT_NE(page.str().find("Seen from above"), std::string::npos);
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

TEST(OdometryCommand, WhatItRecordsCanBeRunInPlaceOfTheImages) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const std::string tracks = (folder.path() / "tracks.csv.gz").string();
  const ProcessResult from_images =
      maploop({"odometry", testing::drive_0013().string(), "--last", "9", "--tracks", tracks});
  ASSERT_EQ(from_images.status, 0) << from_images.error;
  EXPECT_NE(from_images.out.find("pyramids"), std::string::npos) << "stages\n" << from_images.out;
  const ProcessResult from_tracks = maploop({"odometry", tracks});
  ASSERT_EQ(from_tracks.status, 0) << from_tracks.error;
  EXPECT_NE(from_tracks.out.find("frames 0 to 9"), std::string::npos) << from_tracks.out;
  EXPECT_NE(from_tracks.out.find("ok: 9"), std::string::npos) << from_tracks.out;
}

TEST(OdometryCommand, AWayItDoesNotKnowIsRefusedByName) {
  const ProcessResult run = maploop({"odometry", ".", "--motion", "4d-2d"});
  EXPECT_NE(run.status, 0);
  EXPECT_NE(run.error.find("--motion"), std::string::npos) << run.error;
}

TEST(OdometryCommand, WritesItsFiguresAgainstTheTruth) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const TemporaryFolder folder;
  const std::string json = (folder.path() / "figures.json").string();
  const auto tracks = testing::real_data() / "kitti_odometry/tracks/2011_09_26_drive_0001.csv.gz";
  const auto figures = [&](const char* motion) {
    const ProcessResult run =
        maploop({"odometry", tracks.string(), "--motion", motion, "--window", "0", "--json", json});
    EXPECT_EQ(run.status, 0) << run.error;
    return nlohmann::json::parse(std::ifstream(json));
  };
  const nlohmann::json both = figures("3d-2d"), left = figures("2d-2d");
  EXPECT_EQ(both["tracks_a_pair"], left["tracks_a_pair"]) << "the same frames";
  EXPECT_LT(both["segment_100m_percent"], 3.0);
  EXPECT_LT(left["segment_100m_percent"], 20.0) << "it has the lengths of the truth";
  EXPECT_GT(both["inliers_percent"], 80.0);
  EXPECT_EQ(maploop({"odometry", tracks.string(), "--truth", tracks.string()}).status, 2)
      << "of what, without --json";
}

TEST(EvaluateCommand, FirstLastTumAndCsv) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const TemporaryFolder folder;
  const auto truth =
      testing::real_data() / "kitti_odometry/tracks/2011_09_26_drive_0001.truth.csv.gz";
  const std::string tum = (folder.path() / "aligned.tum").string();
  const std::string csv = (folder.path() / "errors.csv").string();
  const ProcessResult run = maploop({"evaluate", truth.string(), truth.string(), "--first", "10",
                                     "--last", "59", "--tum", tum, "--csv", csv});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_EQ(lines_of(tum), 50u);
  EXPECT_EQ(lines_of(csv), 51u);
  EXPECT_NE(run.out.find("50 poses"), std::string::npos) << run.out;
}

TEST(EvaluateCommand, KittisPosesAreShortFromEastToWestAndLongFromNorthToSouth) {
  const TemporaryFolder folder;
  const std::string straight = (folder.path() / "straight.txt").string();
  {
    std::ofstream out(straight);
    for (int i = 0; i <= 20; ++i) out << "1 0 0 0 0 1 0 0 0 0 1 " << 10 * i << '\n';
  }
  const auto end_point = [&](const std::string& azimuth) {
    const std::string json = (folder.path() / "score.json").string();
    const ProcessResult run = maploop(
        {"evaluate", straight, straight, "--kitti-poses-of", "49.0," + azimuth, "--json", json});
    EXPECT_EQ(run.status, 0) << run.error;
    return nlohmann::json::parse(std::ifstream(json))["end_point_percent"].get<double>();
  };
  EXPECT_NEAR(end_point("90"), 0.19, 0.01);
  EXPECT_NEAR(end_point("0"), 0.10, 0.01);
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

TEST(EvaluateCommand, SeveralRunsStandBesideEachOtherAndTheirFiguresAreThoseOfOne) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  const auto truths = testing::real_data() / "kitti/drive_0013_truth";
  const std::string a = (truths / "time_corrected.txt").string(),
                    b = (truths / "velocity_integrated.txt").string(), json = path("score.json");
  ASSERT_EQ(maploop({"evaluate", a, b, "--json", json}).status, 0);
  const auto alone = nlohmann::json::parse(std::ifstream(json));
  const ProcessResult both = maploop({"evaluate", a, b, "--truth", b, "--json", json, "--csv",
                                      path("errors.csv"), "--html", path("page.html")});
  ASSERT_EQ(both.status, 0) << both.error;
  EXPECT_NE(both.out.find("A  time_corrected.txt"), std::string::npos) << both.out;
  const auto scores = nlohmann::json::parse(std::ifstream(json));
  EXPECT_EQ(scores["align"], "se3");
  const auto& first = scores["runs"][0];
  for (const char* part : {"rmse", "mean", "median", "max"})
    EXPECT_NEAR(first["absolute_m"][part], alone["ape_m"][part], 1e-9) << part;
  EXPECT_NEAR(first["kitti"]["percent"], alone["kitti"]["percent"], 1e-6);
  EXPECT_NEAR(first["lengths"][4]["percent"], alone["lengths"][4]["raw"]["percent"], 1e-6);
  EXPECT_LT(scores["runs"][1]["absolute_m"]["max"], 1e-6) << "the truth itself";
  EXPECT_EQ(lines_of(path("errors.csv")), 2u * 144u + 1u);
  const ProcessResult table = maploop({"evaluate", a, b, "--align", "origin", "--table", "csv"});
  EXPECT_EQ(table.out.rfind("figure,unit,time_corrected.txt\n", 0), 0u) << table.out;
}

TEST(EvaluateCommand, WhatCannotBeMeantIsRefusedWithTheRemedy) {
  const ProcessResult three = maploop({"evaluate", "a", "b", "c"});
  EXPECT_NE(three.status, 0);
  EXPECT_NE(three.error.find("--truth"), std::string::npos) << three.error;
  const ProcessResult tum = maploop({"evaluate", "a", "b", "--truth", "c", "--tum", "out.tum"});
  EXPECT_NE(tum.status, 0);
  EXPECT_NE(tum.error.find("--tum"), std::string::npos) << tum.error;
}

// The log of a replay holds both the fused states, as a run, and the reference poses, as the truth.
TEST(EvaluateCommand, ALogIsARunAndATruth) {
  MAPLOOP_REQUIRE_DRIVE();
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "run.mcap").string(),
                    tum = (folder.path() / "run.tum").string();
  ASSERT_EQ(maploop({"replay", testing::drive_0013().string(), "--lockstep", "--no-lcm", "--end",
                     "5", "--record", log, "--tum", tum})
                .status,
            0);
  const std::string json = (folder.path() / "score.json").string();
  const ProcessResult run =
      maploop({"evaluate", log, tum, "--truth", log, "--align", "none", "--json", json});
  ASSERT_EQ(run.status, 0) << run.error;
  const auto runs = nlohmann::json::parse(std::ifstream(json))["runs"];
  EXPECT_GT(runs[0]["unmatched"]["estimate"], 100) << "states between the images";
  EXPECT_NEAR(runs[0]["horizontal_m"]["rmse"], runs[1]["horizontal_m"]["rmse"], 0.5)
      << "both are of the camera";
}

}  // namespace
}  // namespace maploop
