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
#include "sensors/folder/stamps.h"
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

// ---- without the real drive

class Lists : public ::testing::Test {
 protected:
  void image(const std::string& name) const {
    fs::create_directories((folder() / name).parent_path());
    fs::copy_file(small_.folder() / "image_00/data/0000000000.png", folder() / name);
  }
  fs::path folder() const { return folder_.path(); }
  std::string refusal() const {
    return error_of([&] { find_images(folder(), skew); });
  }
  SmallDrive small_;
  maploop::testing::TemporaryFolder folder_;
};

TEST_F(Lists, StampsAreReadFromNamesAndTexts) {
  using std::chrono::nanoseconds;
  EXPECT_EQ(stamp_of("1403636579.763555584"), Time(nanoseconds(1403636579763555584)));
  EXPECT_EQ(stamp_of("1403636579763555584"), Time(nanoseconds(1403636579763555584)));
  EXPECT_EQ(stamp_of("1403636579763555"), Time(nanoseconds(1403636579763555000)));
  EXPECT_EQ(stamp_of("1403636579763"), Time(nanoseconds(1403636579763000000)));
  EXPECT_EQ(stamp_of("1403636579"), Time(nanoseconds(1403636579000000000)));
  EXPECT_EQ(stamp_of("0.1"), Time(nanoseconds(100000000)));
  EXPECT_EQ(stamp_of("2000-01-01 00:00:00"), parse_time("2000-01-01 00:00:00"));
  for (const char* no : {"", "000012", "12", "-1.5", "1.", ".5", "1e9", "scan",
                         "99999999999999999999", "1.5x", "9999999999.0"})
    EXPECT_EQ(stamp_of(no), std::nullopt) << no;
}

TEST_F(Lists, ImagesWithoutPartnerAreLeftOutAndReported) {
  for (const char* name : {"cam0/1.0.png", "cam0/1.1.png", "cam0/1.2.png", "cam1/1.015.png",
                           "cam1/1.215.png", "cam1/9.0.png"})
    image(name);
  DriveParts parts;
  parts.folder = folder();
  parts.images = find_images(folder(), skew);
  parts.calibration.stereo.width = SmallDrive::width;
  parts.calibration.stereo.height = SmallDrive::height;
  const FolderDrive drive(parts, {});
  const auto source = drive.camera();
  const auto pairs = read_all(*source);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[1].stamp, Time(std::chrono::milliseconds(1200)));
  EXPECT_EQ(source->report().refused, 2U);
  EXPECT_THAT(source->report().refusals[0].file, HasSubstr("cam0/1.1.png"));
  EXPECT_THAT(source->report().refusals[1].file, HasSubstr("cam1/9.0.png"));
}

TEST_F(Lists, TimesOfImagesMayBeInAFileForBothCameras) {
  for (const char* name :
       {"image_0/000000.png", "image_0/000001.png", "image_1/000000.png", "image_1/000001.png"})
    image(name);
  EXPECT_THAT(refusal(),
              AllOf(HasSubstr("image_0"), HasSubstr("no stamps"), HasSubstr("times.txt")));
  write_text(folder() / "times.txt", "0.000000e+00\n");
  EXPECT_THAT(refusal(), HasSubstr("has 2 images, but"));
  write_text(folder() / "times.txt", "0.000000e+00\n1.036224e-01\n");
  const auto pair = find_images(folder(), skew);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->right.timestamps.stamps[1], Time(from_seconds(0.1036224)));
  write_text(folder() / "times.txt", "0.2\n0.1\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("times.txt:2"), HasSubstr("do not increase")));
  write_text(folder() / "times.txt", "0 1403636579.5 20\nx y z\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("times.txt:2"), HasSubstr("neither seconds")));
  write_text(folder() / "times.txt", "0 1403636579.5 20\n1 1403636579.6 20\n");
  EXPECT_EQ(find_images(folder(), skew)->left.timestamps.stamps[1],
            Time(std::chrono::milliseconds(1403636579600)));
}

TEST_F(Lists, TheBenchmarksCalibrationIsRead) {
  image("image_0/000000.png");
  write_text(folder() / "calib.txt",
             "P0: 700 0 600 0 0 700 180 0 0 0 1 0\nP1: 700 0 600 -350 0 700 180 0 0 0 1 0\n"
             "Tr: 0 -1 0 0.1 0 0 -1 -0.2 1 0 0 -0.3\n");
  const VehicleCalibration c =
      read_sequence_calibration(folder() / "calib.txt", folder() / "image_0/000000.png");
  EXPECT_EQ(c.stereo.width, SmallDrive::width);
  EXPECT_EQ(c.stereo.baseline, 0.5);
  EXPECT_TRUE(c.T_body_velo.translation().isApprox(Eigen::Vector3d(-0.3, -0.1, 0.2), 1e-12));
  EXPECT_TRUE(c.T_body_velo.linear().isIdentity(1e-12));
  write_text(folder() / "calib.txt", "P0: 700 0 600 0 0 700 180 0 0 0 1 0\n");
  EXPECT_THAT(error_of([&] {
                read_sequence_calibration(folder() / "calib.txt", folder() / "image_0/000000.png");
              }),
              AllOf(HasSubstr("calib.txt"), HasSubstr("P1")));
}

TEST_F(Lists, OneCameraIsRefusedWithItsName) {
  write_text(folder() / "rgb.txt", "# timestamp filename\n1305031102.175304 rgb/a.png\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("rgb.txt"), HasSubstr("one camera alone")));
  fs::remove(folder() / "rgb.txt");
  image("cam0/1.0.png");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("'cam0'"), HasSubstr("none of 'cam1'")));
  EXPECT_TRUE(has_images(folder()));
}

TEST_F(Lists, WrongLinesOfAListAreNamed) {
  const ImageFolder list = parse_image_list(
      "# a comment\n1.5 a.png\nsoon b.png\n1.6 /etc/passwd\n1.7 ../c.png\n1.8\n1403636579763555584,"
      "d.png\r\n",
      "folder/left.txt");
  ASSERT_EQ(list.names.size(), 6U);
  for (const std::size_t i : {1U, 2U, 3U, 4U}) {
    ASSERT_TRUE(list.timestamps.verdicts[i]) << i;
    EXPECT_EQ(list.timestamps.verdicts[i]->line, i + 2);
  }
  EXPECT_FALSE(list.timestamps.verdicts[0] || list.timestamps.verdicts[5]);
  EXPECT_EQ(list.names[5], "d.png");
  EXPECT_THAT(error_of([] { parse_image_list("# nothing\n", "left.txt"); }),
              HasSubstr("'left.txt' has no line"));
}

TEST_F(Lists, ADriveOfNothingIsRefused) {
  DriveParts parts;
  parts.folder = "somewhere";
  EXPECT_THAT(error_of([&] { FolderDrive(parts, {}); }),
              AllOf(HasSubstr("somewhere"), HasSubstr("neither images")));
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
