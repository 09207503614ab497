// These tests replay KITTI's frames in the layouts of other data sets, and broken folders.
#include "sensors/folder/folder_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <optional>

#include "sensors/cloud/scan_folder.h"
#include "sensors/folder/euroc.h"
#include "sensors/folder/image_lists.h"
#include "sensors/folder/kitti_360.h"
#include "tests/sensors/folder_forms.h"
#include "tests/sensors/small_drive.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;
using maploop::testing::error_of;
using maploop::testing::write_as_euroc;
using maploop::testing::write_as_kitti_360;
using maploop::testing::write_as_lists;
using maploop::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr Duration skew = std::chrono::milliseconds(20);
constexpr std::size_t frames = 5;

// The real drive, or else a small one, whose images EuRoC's rectification would change.
class FolderForms : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_DRIVE();
    kitti_.emplace(maploop::testing::drive_0013());
  }
  void expect_same_images(const FolderDrive& drive) const {
    const auto expected = kitti_->camera(), found = drive.camera();
    StereoPair a, b;
    for (std::size_t i = 0; i < frames; ++i) {
      ASSERT_TRUE(expected->next(a) && found->next(b));
      EXPECT_EQ(a.stamp, b.stamp);
      EXPECT_EQ(a.available, b.available);
      EXPECT_EQ(a.left.pixels, b.left.pixels);
      EXPECT_EQ(a.right.pixels, b.right.pixels);
    }
    EXPECT_FALSE(found->next(b));
    EXPECT_EQ(found->report().refused, 0U);
  }
  void expect_same_scans(const FolderDrive& drive) const {
    const auto expected = kitti_->velodyne(), found = drive.velodyne();
    LidarScan a, b;
    for (std::size_t i = 0; i < frames; ++i) {
      ASSERT_TRUE(expected->next(a) && found->next(b));
      EXPECT_EQ(a.stamp, b.stamp);
      ASSERT_EQ(a.points.size(), b.points.size());
      EXPECT_EQ(std::memcmp(a.points.data(), b.points.data(), a.points.size() * 16), 0);
    }
    EXPECT_FALSE(found->next(b));
  }
  void expect_same_calibration(const VehicleCalibration& c) const {
    const StereoCalibration& a = kitti_->calibration().stereo;
    EXPECT_EQ(a.width, c.stereo.width);
    EXPECT_NEAR(a.fx, c.stereo.fx, 1e-9);
    EXPECT_NEAR(a.baseline, c.stereo.baseline, 1e-12);
    EXPECT_TRUE(a.T_body_cam.isApprox(c.stereo.T_body_cam, 1e-12));
  }
  FolderDrive opened(DriveParts parts) const { return {std::move(parts), {}}; }

  std::optional<KittiDrive> kitti_;
  maploop::testing::TemporaryFolder folder_;
};

TEST_F(FolderForms, Kitti360HasTheBitsOfKitti) {
  write_as_kitti_360(*kitti_, folder_.path(), frames);
  const fs::path drive_folder = folder_.path() / "data_3d_raw/2013_05_28_drive_0000_sync";
  for (const fs::path& path : {folder_.path(), drive_folder, drive_folder / ""}) {
    const auto name = find_kitti_360(path);
    ASSERT_TRUE(name) << path;
    const FolderDrive drive = opened(open_kitti_360(*name));
    EXPECT_EQ(drive.frame_count(), frames);
    expect_same_images(drive);
    expect_same_scans(drive);
    expect_same_calibration(drive.calibration());
    EXPECT_TRUE(drive.calibration().T_body_velo.isApprox(kitti_->calibration().T_body_velo, 1e-12));
    const auto expected = read_all(*kitti_->imu()), found = read_all(*drive.imu());
    ASSERT_EQ(found.size(), frames);
    for (std::size_t i = 0; i < frames; ++i) {
      EXPECT_EQ(found[i].stamp, expected[i].stamp);
      EXPECT_EQ(found[i].yaw_rate, expected[i].yaw_rate);
    }
    EXPECT_EQ(drive.notes().size(), 1U);
  }
}

TEST_F(FolderForms, Kitti360MayLackAnyPartButNotAll) {
  write_as_kitti_360(*kitti_, folder_.path(), frames);
  const auto open = [&] { return opened(open_kitti_360(*find_kitti_360(folder_.path()))); };
  fs::remove_all(folder_.path() / "data_2d_raw");
  const FolderDrive without_images = open();
  EXPECT_FALSE(without_images.has_images());
  EXPECT_EQ(without_images.frame_count(), frames);
  expect_same_scans(without_images);
  fs::remove_all(folder_.path() / "data_3d_raw");
  fs::remove_all(folder_.path() / "calibration");  // which only images and scans need
  EXPECT_EQ(read_all(*open().reference()).size(), frames);
  fs::create_directories(folder_.path() / "data_poses/2013_05_28_drive_0002_sync");
  EXPECT_THAT(error_of([&] { find_kitti_360(folder_.path()); }),
              AllOf(HasSubstr("has 2 drives"), HasSubstr("drive_0000_sync"),
                    HasSubstr("drive_0002_sync"), HasSubstr("name the folder of one")));
}

TEST_F(FolderForms, EurocHasTheFramesOfKitti) {
  write_as_euroc(*kitti_, folder_.path(), frames);
  const auto mav0 = find_euroc(folder_.path());
  ASSERT_TRUE(mav0);
  EXPECT_EQ(find_euroc(*mav0), mav0);
  DriveParts parts = open_euroc(*mav0, skew, {});
  const StereoCalibration& kitti = kitti_->calibration().stereo;
  EXPECT_NEAR(parts.calibration.stereo.baseline, kitti.baseline, 1e-12);
  EXPECT_TRUE(parts.calibration.stereo.T_body_cam.isApprox(kitti.T_body_cam, 1e-9));
  const auto& rig = *parts.raw_cameras;
  EXPECT_EQ(rig.width, kitti.width);
  const FolderDrive rectified = opened(parts);
  StereoPair pair;
  ASSERT_TRUE(rectified.camera()->next(pair));
  EXPECT_EQ(pair.left.width, kitti.width);
  // The images before their rectification are the drive's, bit for bit.
  parts.raw_cameras.reset();
  expect_same_images(opened(parts));
  const auto imu = parts.tables->imu(nullptr, parts.mount, 0.0);
  const auto expected = kitti_->imu();
  ImuSample a, b;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(expected->next(a) && imu->next(b));
    EXPECT_EQ(a.stamp, b.stamp) << "to the nanosecond";
    EXPECT_NEAR(a.yaw_rate, b.yaw_rate, 1e-12);
    EXPECT_NEAR(a.specific_force_forward, b.specific_force_forward, 1e-9);
  }
}

TEST_F(FolderForms, EurocsTruthIsInTheBodysAxes) {
  write_as_euroc(*kitti_, folder_.path(), frames);
  write_text(folder_.path() / "mav0/state_groundtruth_estimate0/data.csv",
             "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y "
             "[], q_RS_z [], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x "
             "[rad s^-1], b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], "
             "b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\n"
             "1403636580838555648,4,-2,0.5,0.70710678118654757,0,0,0.70710678118654757,1,2,3,0,0,0,"
             "0,0,0\n");
  const DriveParts parts = open_euroc(*find_euroc(folder_.path()), skew, {});
  const auto poses = read_all(*parts.tables->reference());
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_EQ(to_nanoseconds(poses[0].stamp), 1403636580838555648);
  EXPECT_TRUE(LocalFrame().to_enu(poses[0].position).isApprox(Eigen::Vector3d(4, -2, 0.5), 1e-6));
  EXPECT_EQ(poses[0].velocity_enu, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(poses[0].attitude.azimuth, 0.0, 1e-9);  // x points to the north
}

TEST_F(FolderForms, ADriveWithOneCameraOrWithoutItsListIsRefused) {
  write_as_euroc(*kitti_, folder_.path(), frames);
  const fs::path mav0 = folder_.path() / "mav0";
  fs::rename(mav0 / "cam1/data.csv", mav0 / "cam1/kept.csv");
  EXPECT_THAT(error_of([&] { open_euroc(mav0, skew, {}); }),
              AllOf(HasSubstr("cam1/data.csv"), HasSubstr("one camera")));
}

TEST_F(FolderForms, ListsOfImagesAndCloudsNamedByStampsHaveTheBitsOfKitti) {
  write_as_lists(*kitti_, folder_.path(), frames);
  DriveParts parts;
  parts.folder = folder_.path();
  parts.images = find_images(folder_.path(), skew);
  parts.clouds = find_scans(folder_.path()).value_or("");
  parts.calibration = kitti_->calibration();
  const FolderDrive drive = opened(parts);
  expect_same_images(drive);
  expect_same_scans(drive);
  EXPECT_EQ(drive.first_stamp(), kitti_->first_stamp());
}

// ---- KITTI's raw layout with parts missing

TEST(KittiParts, ScansOrRowsAloneAreADrive) {
  const SmallDrive scans;
  for (const char* part : {"image_00", "image_01", "oxts"}) scans.remove(part);
  const KittiDrive lidar(scans.folder());
  EXPECT_FALSE(lidar.has_images() || lidar.has_oxts());
  EXPECT_EQ(read_all(*lidar.velodyne()).size(), SmallDrive::frames);
  EXPECT_EQ(lidar.frame_count(), SmallDrive::frames);
  EXPECT_EQ(lidar.first_stamp(), parse_time("2011-09-26 13:10:50.98"));
  EXPECT_THROW(lidar.camera(), std::runtime_error);
  const KittiDrive with_images(SmallDrive().folder());
  EXPECT_TRUE(lidar.calibration().T_body_velo.isApprox(with_images.calibration().T_body_velo));
  for (const char* file : {"cam_to_cam", "velo_to_cam", "imu_to_velo"})
    scans.remove("../calib_" + std::string(file) + ".txt");
  const KittiDrive bare(scans.folder());
  EXPECT_EQ(bare.notes().size(), 1U);

  const SmallDrive rows;
  for (const char* part : {"image_00", "image_01", "velodyne_points"}) rows.remove(part);
  const KittiDrive oxts(rows.folder());
  EXPECT_EQ(read_all(*oxts.imu()).size(), SmallDrive::frames);
  EXPECT_EQ(oxts.last_stamp(), parse_time("2011-09-26 13:10:51.701"));
}

TEST(KittiParts, OneCameraAloneIsNamed) {
  const SmallDrive small;
  small.remove("image_01");
  EXPECT_THAT(error_of([&] { KittiDrive(small.folder()); }), HasSubstr("no folder image_01"));
}

TEST(KittiParts, WithoutAnyStampsTenHertzAreAssumedAndSaid) {
  const SmallDrive small;
  for (const char* file : {"image_00/timestamps.txt", "image_01/timestamps.txt",
                           "velodyne_points/timestamps.txt", "velodyne_points/timestamps_start.txt",
                           "velodyne_points/timestamps_end.txt", "oxts/timestamps.txt"})
    small.remove(file);
  const KittiDrive drive(small.folder());
  ASSERT_EQ(drive.notes().size(), 1U);
  EXPECT_THAT(drive.notes()[0], HasSubstr("0.1 s apart"));
  const auto pairs = read_all(*drive.camera());
  ASSERT_EQ(pairs.size(), SmallDrive::frames);
  EXPECT_EQ(pairs[3].stamp - pairs[0].stamp, std::chrono::milliseconds(300));
  EXPECT_EQ(read_all(*drive.velodyne()).size(), SmallDrive::frames);
  EXPECT_EQ(read_all(*drive.imu()).size(), SmallDrive::frames);
}

// ---- scans alone

TEST(ScansAlone, AreStampedByTheirNamesOrByAFile) {
  const maploop::testing::TemporaryFolder folder;
  const std::string bin(16, '\0');
  for (const char* name : {"1403636579.1.bin", "1403636579.2.bin"})
    write_text(folder.path() / name, bin);
  const auto named = read_all(*make_scan_source(folder.path(), std::chrono::milliseconds(250), {}));
  ASSERT_EQ(named.size(), 2U);
  EXPECT_EQ(named[1].stamp, Time(std::chrono::milliseconds(1403636579200)));
  EXPECT_TRUE(ScanFolder(folder.path()).assumption().empty());
  write_text(folder.path() / "times.txt", "5.0\n5.5\n");
  EXPECT_EQ(ScanFolder(folder.path()).stamps()[1], Time(std::chrono::milliseconds(5500)));
}

}  // namespace
}  // namespace maploop::sensors
