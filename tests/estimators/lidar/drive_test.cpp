// These tests run the visual-LiDAR odometer on the recorded drive and compare it with the
// reference. They take the better part of a minute, since the whole drive is needed eight times,
// once for each way to seed and to halve it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <span>
#include <utility>

#include "estimators/lidar/visual_lidar_odometer.h"
#include "estimators/stereo/stereo_odometry.h"
#include "msgs/frames.h"
#include "tests/estimators/lidar/drive_scans.h"
#include "tests/estimators/stereo/drive_pairs.h"
#include "tests/support/real_data.h"
#include "tools/evaluate/kitti_metric.h"
#include "tools/evaluate/trajectory_file.h"

namespace maploop::lidar {
namespace {

using evaluation::Trajectory;
using maploop::testing::drive_0013;

enum class Seed { visual, motion, none };

struct DriveResult {
  Trajectory camera;  // poses of the left camera relative to its first pose, at the images' stamps
  std::vector<LidarMotion> motions;
  int iterations = 0;
};

class LidarDriveTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (drive_0013().empty()) return;
    cv::setNumThreads(1);
    every_visual = visual_motions({});
  }
  void SetUp() override {
    MAPLOOP_REQUIRE_DRIVE();
    MAPLOOP_REQUIRE_REAL_DATA();
  }

  static std::vector<VisualMotion> visual_motions(const stereo::StereoParameters& parameters) {
    const sensors::KittiDrive drive(drive_0013());
    stereo::StereoOdometry odometry(drive.calibration().stereo, parameters);
    std::vector<VisualMotion> motions;
    for (const StereoPair& pair : maploop::testing::read_pairs(drive)) {
      motions.push_back(odometry.process(pair));
    }
    return motions;
  }

  // Runs every `every`-th scan with the visual motions of all pairs. Each run is done once.
  static const DriveResult& run(Seed seed, std::size_t every = 1) {
    static std::map<std::pair<Seed, std::size_t>, DriveResult> runs;
    const auto [run, fresh] = runs.try_emplace({seed, every});
    if (fresh) run->second = make_run(seed, every);
    return run->second;
  }

  // Returns what a scanner that does not turn would have seen: only what is at most 35 degrees to
  // the left or right, the last point first.
  static LidarScan seen_ahead(const LidarScan& scan) {
    LidarScan ahead;
    static_cast<Sample&>(ahead) = scan;
    const PointTimes time_of(scan, scan.stamp);
    for (std::size_t i = scan.points.size(); i-- > 0;) {
      const LidarPoint& p = scan.points[i];
      if (std::abs(std::atan2(p.y, p.x)) > radians(35.0)) continue;
      ahead.points.push_back(p);
      ahead.times.push_back(time_of(i));
    }
    const auto [first, last] = std::ranges::minmax(ahead.times);
    ahead.start = scan.stamp + from_seconds(static_cast<double>(first));
    ahead.end = scan.stamp + from_seconds(static_cast<double>(last));
    return ahead;
  }

  static DriveResult make_run(Seed seed, std::size_t every, bool ahead = false) {
    const sensors::KittiDrive drive(drive_0013());
    LidarParameters parameters = maploop::testing::lidar_parameters(drive);
    const Eigen::Isometry3d T_body_cam = drive.calibration().stereo.T_body_cam;
    parameters.constant_motion = seed != Seed::none;
    LidarOdometry odometry(drive.calibration().T_body_velo, parameters);
    DriveResult result;
    const auto velodyne = drive.velodyne();
    LidarScan scan;
    for (std::size_t i = 0; i < every_visual.size() && velodyne->next(scan); ++i) {
      RelativeMotion visual = every_visual[i];
      if (seed != Seed::visual) visual.status = OdometryStatus::too_few_features;
      const bool used = i % every == 0;
      const LidarScan& seen = ahead ? seen_ahead(scan) : scan;
      // The 20 ms of what is ahead are not always those of an image.
      const OdometerResult r = odometry.process(used ? &seen : nullptr, ahead ? nullptr : &visual);
      if (used) result.motions.push_back(r.lidar);
      result.iterations += r.lidar.iterations;
      result.camera.push_back(T_body_cam.inverse() * odometry.pose() * T_body_cam);
    }
    return result;
  }

  static Trajectory truth() {
    return evaluation::read_kitti_poses(maploop::testing::real_data() /
                                        "kitti/drive_0013_truth/velocity_integrated.txt");
  }

  static evaluation::Score error(const DriveResult& run) {
    return evaluation::score(run.camera, truth(), 100.0, evaluation::CommonRotation::remove);
  }

  static std::vector<VisualMotion> every_visual;
};

std::vector<VisualMotion> LidarDriveTest::every_visual;

TEST_F(LidarDriveTest, FollowsTheReferenceWithEverySeed) {
  std::array<int, 3> iterations{};
  for (const Seed seed : {Seed::visual, Seed::motion, Seed::none}) {
    const DriveResult& r = run(seed);
    ASSERT_EQ(r.motions.size(), 144u);
    // With visual motion the map starts at the second scan, the first with a known motion.
    for (std::size_t i = seed == Seed::visual ? 2 : 1; i < r.motions.size(); ++i) {
      EXPECT_EQ(r.motions[i].status, OdometryStatus::ok)
          << "scan " << i << ": " << to_string(r.motions[i].status);
    }
    const auto e = error(r);
    std::printf("%.3f %%, %.5f deg/m, %.2f m\n", e.segment.percent, e.segment.deg_per_m,
                e.end_point_m);
    EXPECT_LT(e.segment.percent, 0.32);      // reached 0.27
    EXPECT_LT(e.segment.deg_per_m, 0.0035);  // reached 0.0029 to 0.0030
    EXPECT_LT(e.end_point_m, 1.3);           // reached 0.9 to 1.0 m
    iterations[static_cast<std::size_t>(seed)] = r.iterations;
  }
  EXPECT_LT(iterations[0], iterations[2] * 2 / 3) << "what the seed saves";
}

TEST_F(LidarDriveTest, AScannerThatSeesOnlyWhatIsAheadFollowsTheReference) {
  const DriveResult r = make_run(Seed::motion, 1, true);
  for (std::size_t i = 1; i < r.motions.size(); ++i)
    EXPECT_EQ(r.motions[i].status, OdometryStatus::ok) << "scan " << i;
  const auto e = error(r);
  std::printf("%.3f %%, %.5f deg/m, %.2f m\n", e.segment.percent, e.segment.deg_per_m,
              e.end_point_m);
  EXPECT_LT(e.segment.percent, 0.30);      // reached 0.28
  EXPECT_LT(e.segment.deg_per_m, 0.0048);  // reached 0.0044
  EXPECT_LT(e.end_point_m, 0.9);           // reached 0.74
}

TEST_F(LidarDriveTest, EveryFifthAndTenthScanHoldWithVisualSeeds) {
  const double all = error(run(Seed::visual)).segment.percent;
  for (const std::size_t every : {5u, 10u}) {
    const DriveResult& r = run(Seed::visual, every);
    for (std::size_t i = 2; i < r.motions.size(); ++i) {
      EXPECT_EQ(r.motions[i].status, OdometryStatus::ok) << "every " << every << ", scan " << i;
    }
    EXPECT_NEAR(error(r).segment.percent, all, 0.1) << "every " << every;
  }
}

// Runs both odometries as the vehicle does. The scans must teach their own length, not one that
// depends on visual odometry.
TEST_F(LidarDriveTest, GivesVisualMotionsItsLength) {
  const sensors::KittiDrive drive(drive_0013());
  const auto length_learnt = [&](std::span<const VisualMotion> visual) {
    VisualLidarOdometer odometer(drive.calibration().T_body_velo,
                                 maploop::testing::lidar_parameters(drive));
    const DisparityCorrection& correction = odometer.correction();
    const auto velodyne = drive.velodyne();
    LidarScan scan;
    double raw = 0.0, corrected = 0.0,
           of_scans = 0.0;  // m, path lengths after the first five seconds
    for (std::size_t i = 0; i < visual.size() && velodyne->next(scan); ++i) {
      const RelativeMotion motion = correction.correct(visual[i]);
      const LidarMotion by_scan = odometer.process(&scan, &visual[i]).lidar;
      if (i < 50) continue;
      raw += visual[i].translation.norm();
      corrected += motion.translation.norm();
      of_scans += by_scan.translation.norm();
    }
    std::printf("longer than the scans' way: %.2f %%, corrected %.2f %%; %.3f +- %.3f px\n",
                100.0 * (raw / of_scans - 1.0), 100.0 * (corrected / of_scans - 1.0),
                correction.offset(), correction.sigma());
    return std::pair(raw / of_scans, corrected / of_scans);
  };

  const auto [raw, corrected] = length_learnt(every_visual);
  EXPECT_LT(raw, 0.998);                // 0.9971
  EXPECT_NEAR(corrected, 1.0, 0.0015);  // reached 0.9996

  // Pairs assumed to be perfectly rectified give motions that are too long.
  stereo::StereoParameters as_rectified;
  as_rectified.sigma_disparity_offset = 0.0;
  const auto [raw_as_rectified, corrected_as_rectified] =
      length_learnt(visual_motions(as_rectified));
  EXPECT_GT(raw_as_rectified, 1.004);                // 1.0051
  EXPECT_NEAR(corrected_as_rectified, 1.0, 0.0015);  // reached 0.9996
}

// The points are split in two halves, each with its own map. The motions of the two odometries over
// a second must differ by no more than both covariances predict.
TEST_F(LidarDriveTest, CovarianceIsWhatHalvesOfThePointsDifferBy) {
  const sensors::KittiDrive drive(drive_0013());
  std::array<std::vector<LidarMotion>, 2> motions;
  for (std::size_t half = 0; half < 2; ++half) {
    LidarOdometry odometry(drive.calibration().T_body_velo,
                           maploop::testing::lidar_parameters(drive));
    const auto velodyne = drive.velodyne();
    LidarScan scan;
    for (std::size_t i = 0; i < every_visual.size() && velodyne->next(scan); ++i) {
      // The halves are blocks of 2 m, as on a chess board.
      std::erase_if(scan.points, [&](const LidarPoint& p) {
        const auto block = [](float x) { return static_cast<int>(std::floor(x / 2.0f)); };
        return static_cast<std::size_t>(std::abs(block(p.x) + block(p.y) + block(p.z)) % 2) != half;
      });
      motions[half].push_back(odometry.process(&scan, nullptr).lidar);
    }
  }
  double nees = 0.0;
  int windows = 0;
  for (std::size_t begin = 20; begin + 10 <= every_visual.size(); begin += 10) {
    std::array<Eigen::Isometry3d, 2> T{Eigen::Isometry3d::Identity(),
                                       Eigen::Isometry3d::Identity()};
    Matrix6d covariance = Matrix6d::Zero();
    for (std::size_t half = 0; half < 2; ++half) {
      for (std::size_t i = begin; i < begin + 10; ++i) {
        const LidarMotion& m = motions[half][i];
        ASSERT_EQ(m.status, OdometryStatus::ok);
        T[half] = T[half] * m.T_from_to();
        covariance += m.covariance;
      }
    }
    const Eigen::Isometry3d difference = T[0].inverse() * T[1];
    const Eigen::AngleAxisd turn(difference.linear());
    Vector6d d;
    d << difference.translation(), turn.angle() * turn.axis();
    nees += d.dot(covariance.inverse() * d);
    ++windows;
  }
  ASSERT_GE(windows, 12);
  nees /= 6.0 * windows;  // 1 if the covariance is right
  RecordProperty("nees", std::to_string(nees));
  std::printf("normalized error of halves over 1 s: %.2f a degree of freedom\n", nees);
  // The margin allows for the shared errors: deskew, calibration, range scale.
  EXPECT_GT(nees, 0.01);
  EXPECT_LT(nees, 1.0);
}

// The increments are over a second, with the reference's own covariance added. That covariance was
// estimated on this drive, from the differences between reference, LiDAR and visual odometry for
// each pair. The test shows that the covariance stays consistent with it; it is not an independent
// proof.
TEST_F(LidarDriveTest, CovarianceStaysConsistentWithTheReferenceOverASecond) {
  const DriveResult& r = run(Seed::visual);
  const Trajectory reference_poses = truth();
  const Eigen::Isometry3d common(evaluation::fit_common_rotation(r.camera, reference_poses));
  const sensors::KittiDrive drive(drive_0013());
  Matrix6d to_cam = Matrix6d::Zero();
  to_cam.topLeftCorner<3, 3>() = to_cam.bottomRightCorner<3, 3>() =
      drive.calibration().stereo.T_body_cam.linear().transpose();
  Vector6d reference;
  reference << 0.065, 0.015, 0.03, Eigen::Vector3d::Constant(radians(0.025));
  double nees = 0.0;
  int windows = 0;
  for (std::size_t begin = 3; begin + 10 < r.camera.size(); begin += 10) {
    Matrix6d covariance = Matrix6d::Zero();
    for (std::size_t i = begin + 1; i <= begin + 10; ++i) covariance += r.motions[i].covariance;
    covariance = to_cam * covariance * to_cam.transpose();
    covariance.diagonal() += reference.cwiseAbs2();
    Eigen::Isometry3d moved = r.camera[begin].inverse() * r.camera[begin + 10];
    moved = common * moved * common.inverse();
    const Eigen::Isometry3d error =
        moved.inverse() * (reference_poses[begin].inverse() * reference_poses[begin + 10]);
    const Eigen::AngleAxisd turn(error.linear());
    Vector6d d;
    d << error.translation(), turn.angle() * turn.axis();
    nees += d.dot(covariance.inverse() * d);
    ++windows;
  }
  ASSERT_GE(windows, 13);
  nees /= 6.0 * windows;
  std::printf("normalized error against the reference over 1 s: %.2f a degree of freedom\n", nees);
  EXPECT_GT(nees, 0.5);
  EXPECT_LT(nees, 1.7);
}

}  // namespace
}  // namespace maploop::lidar
