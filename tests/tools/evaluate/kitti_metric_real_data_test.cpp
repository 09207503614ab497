// Tests the metric against an independent program (score_poses.py, numpy) and against published
// figures.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/support/real_data.h"
#include "tools/evaluate/kitti_metric.h"

namespace maploop::evaluation {
namespace {

namespace fs = std::filesystem;

// The system's python3 has Debian's python3-numpy; another python3 in the PATH does not.
const std::string python_interpreter = "/usr/bin/python3";

std::string quoted(const fs::path& path) {
  return std::string("'").append(path.string()).append("'");
}

// Returns what a command prints. Throws if it fails.
std::string output_of(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start " + command);
  std::string text;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) text += part.data();
  if (pclose(pipe) != 0) throw std::runtime_error("failed: " + command);
  return text;
}

class KittiMetricOnRealData : public ::testing::Test {
 protected:
  void SetUp() override { MAPLOOP_REQUIRE_REAL_DATA(); }

  fs::path data() const { return maploop::testing::real_data(); }

  // Unpacks a file of kitti_odometry.
  fs::path unpacked(const fs::path& name) const {
    fs::path target = folder_.path() / name.filename();
    output_of(
        "python3 -c 'import gzip, sys; open(sys.argv[2], \"wb\").write(gzip.open(sys.argv[1])."
        "read())' " +
        quoted(data() / "kitti_odometry" / (name.string() + ".gz")) + " " + quoted(target));
    return target;
  }

  // Runs both programs on the same two files; score_poses.py prints three to five decimals.
  void expect_same_as_script(const fs::path& estimate, const fs::path& truth, double length,
                             CommonRotation rotation) const {
    SCOPED_TRACE(estimate.string() + " at " + std::to_string(length));
    const bool remove = rotation == CommonRotation::remove;
    std::istringstream printed(output_of(
        python_interpreter + " " + quoted(script()) + " " + quoted(estimate) + " " + quoted(truth) +
        " " + std::to_string(length) + (remove ? " --common-rotation" : "")));
    double end_percent = 0, end_m = 0, percent = 0, deg_per_m = 0;
    int frames = 0;
    ASSERT_TRUE(printed >> end_percent >> end_m >> percent >> deg_per_m >> frames);
    const Score ours = score(read_kitti_poses(estimate), read_kitti_poses(truth), length, rotation);
    EXPECT_NEAR(ours.end_point_percent, end_percent, 0.00051);
    EXPECT_NEAR(ours.end_point_m, end_m, 0.00051);
    EXPECT_NEAR(ours.segment.percent, percent, 0.00051);
    EXPECT_NEAR(ours.segment.deg_per_m, deg_per_m, 0.0000051);
    EXPECT_EQ(ours.frames, frames);
    EXPECT_GT(ours.segment.segments, 0);
  }

  fs::path script() const { return data() / ".." / "tools" / "score_poses.py"; }

  bool script_runs() const {
    return fs::exists(script()) &&
           std::system((python_interpreter + " -c 'import numpy' 2>/dev/null").c_str()) == 0;
  }

  maploop::testing::TemporaryFolder folder_;
};

TEST_F(KittiMetricOnRealData, AgreesWithScorePoses) {
  if (!script_runs()) {
    GTEST_SKIP() << "SKIPPED, NOT TESTED: needs python3-numpy and " << script();
  }
  const fs::path drive = data() / "kitti" / "drive_0013_truth";
  const fs::path peer_10 = unpacked("peers/10_unnamed_LeoQLi.txt");
  const fs::path truth_10 = unpacked("poses/10.txt");
  for (const auto rotation : {CommonRotation::keep, CommonRotation::remove}) {
    for (const double length : {25.0, 100.0}) {
      expect_same_as_script(drive / "velocity_integrated.txt", drive / "time_corrected.txt", length,
                            rotation);
    }
    expect_same_as_script(peer_10, truth_10, 100.0, rotation);
    expect_same_as_script(peer_10, truth_10, 400.0, rotation);
  }
}

struct Peer {
  const char* estimate;
  const char* truth;
  double percent;    // measured elsewhere, to two decimals
  double deg_per_m;  // measured elsewhere, to four decimals
};

TEST_F(KittiMetricOnRealData, ReproducesThePublishedFiguresOfThreePeers) {
  for (const Peer& peer : {Peer{"peers/00_ORB_evo.txt", "poses/00.txt", 0.70, 0.0025},
                           Peer{"peers/00_SPTAM_evo.txt", "poses/00.txt", 1.49, 0.0056},
                           Peer{"peers/10_unnamed_LeoQLi.txt", "poses/10.txt", 0.96, 0.0041}}) {
    SCOPED_TRACE(peer.estimate);
    const SegmentError error = kitti_odometry_error(read_kitti_poses(unpacked(peer.estimate)),
                                                    read_kitti_poses(unpacked(peer.truth)));
    EXPECT_NEAR(error.percent, peer.percent, 0.0051);
    EXPECT_NEAR(error.deg_per_m, peer.deg_per_m, 0.000051);
  }
}

}  // namespace
}  // namespace maploop::evaluation
