// These tests read lists of images of folders of any layout.
#include "sensors/folder/image_lists.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sensors/folder/sequence_calibration.h"
#include "sensors/folder/stamps.h"
#include "tests/sensors/folder_forms.h"
#include "tests/sensors/small_drive.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;
using maploop::testing::error_of;
using maploop::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr Duration widest_skew = std::chrono::milliseconds(20);

class Lists : public ::testing::Test {
 protected:
  void image(const std::string& name) const {
    fs::create_directories((folder() / name).parent_path());
    fs::copy_file(small_.folder() / "image_00/data/0000000000.png", folder() / name);
  }
  fs::path folder() const { return folder_.path(); }
  std::string refusal() const {
    return error_of([&] { find_images(folder(), widest_skew); });
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
  for (const char* no : {"14036365798135", "", "000012", "12", "-1.5", "1.", ".5", "1e9", "scan",
                         "99999999999999999999", "1.5x", "9999999999.0"})
    EXPECT_EQ(stamp_of(no), std::nullopt) << no;
}

TEST_F(Lists, ImagesWithoutPartnerAreLeftOutAndReported) {
  for (const char* name : {"cam0/1.0.png", "cam0/1.1.png", "cam0/1.2.png", "cam1/1.015.png",
                           "cam1/1.215.png", "cam1/9.0.png"})
    image(name);
  DriveParts parts;
  parts.folder = folder();
  parts.images = find_images(folder(), widest_skew);
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
  const auto pair = find_images(folder(), widest_skew);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->right.timestamps.stamps[1], Time(from_seconds(0.1036224)));
  write_text(folder() / "times.txt", "0.2\n0.1\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("times.txt:2"), HasSubstr("do not increase")));
  write_text(folder() / "times.txt", "0 1403636579.5 20\nx y z\n");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("times.txt:2"), HasSubstr("neither seconds")));
  write_text(folder() / "times.txt", "0 1403636579.5 20\n1 1403636579.6 20\n");
  EXPECT_EQ(find_images(folder(), widest_skew)->left.timestamps.stamps[1],
            Time(std::chrono::milliseconds(1403636579600)));
}

TEST_F(Lists, TheBenchmarksCalibrationIsRead) {
  image("image_0/000000.png");
  write_text(folder() / "calib.txt",
             "P0: 700 0 600 0 0 700 180 0 0 0 1 0\nP1: 700 0 600 -350 0 700 180 0 0 0 1 0\n"
             "Tr: 0 -1 0 0.1 0 0 -1 -0.2 1 0 0 -0.3\n");
  ImageFolder images;
  images.data = folder() / "image_0";
  images.names = {"000000.png"};
  const VehicleCalibration c = read_sequence_calibration(folder() / "calib.txt", images);
  EXPECT_EQ(c.stereo.width, SmallDrive::width);
  EXPECT_EQ(c.stereo.baseline, 0.5);
  EXPECT_TRUE(c.T_body_velo.translation().isApprox(Eigen::Vector3d(-0.3, -0.1, 0.2), 1e-12));
  EXPECT_TRUE(c.T_body_velo.linear().isIdentity(1e-12));
  write_text(folder() / "calib.txt", "P0: 700 0 600 0 0 700 180 0 0 0 1 0\n");
  EXPECT_THAT(error_of([&] { read_sequence_calibration(folder() / "calib.txt", images); }),
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

}  // namespace
}  // namespace maploop::sensors
