// These drives have something missing, cut or wrong. They are refused at opening with a clear
// error, or the sample is left out, reported and counted.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "sensors/image/jpeg.h"
#include "sensors/image/png.h"
#include "sensors/replay/kitti_drive.h"
#include "tests/sensors/small_drive.h"
#include "tests/support/error_of.h"

namespace maploop::sensors {
namespace {

using maploop::testing::error_of;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using Sequences = std::vector<std::uint64_t>;

// The finding's file may be the end of its path, and its reason a part of what is said.
void expect_finding(const Finding& finding, const Finding& expected) {
  EXPECT_THAT(finding.file, EndsWith(expected.file));
  EXPECT_EQ(finding.line, expected.line);
  EXPECT_THAT(finding.reason, HasSubstr(expected.reason));
}

// Expects that a source delivers these samples and refuses one.
template <class T>
void expect_one_refused(std::unique_ptr<Source<T>> source, const Sequences& delivered,
                        const Finding& expected) {
  EXPECT_EQ(sequences(read_all(*source)), delivered);
  const SourceReport& report = source->report();
  EXPECT_EQ(report.delivered, delivered.size());
  EXPECT_EQ(report.refused, 1U);
  ASSERT_EQ(report.refusals.size(), 1U);
  expect_finding(report.refusals[0], expected);
}

const Sequences all{0, 1, 2, 3, 4, 5, 6, 7};
const Sequences without_3{0, 1, 2, 4, 5, 6, 7};

TEST(SmallDrive, IsSound) {
  const SmallDrive small;
  const KittiDrive drive(small.folder());
  EXPECT_EQ(drive.frame_count(), SmallDrive::frames);
  EXPECT_EQ(sequences(read_all(*drive.camera())), all);
  EXPECT_EQ(sequences(read_all(*drive.velodyne())), all);
  EXPECT_EQ(sequences(read_all(*drive.imu())), all);
  EXPECT_EQ(sequences(read_all(*drive.reference())), all);
  EXPECT_EQ(sequences(read_all(*drive.gnss())), (Sequences{0}));

  const auto after = [](int ms) {
    return parse_time("2011-09-26 13:10:51") + std::chrono::milliseconds(ms);
  };
  const auto pairs = read_all(*drive.camera());
  EXPECT_EQ(pairs.at(3).stamp, after(300));
  EXPECT_EQ(pairs.at(3).available, after(307));  // that of the later image, plus 5 ms of readout
  EXPECT_NE(pairs.at(3).left.pixels, pairs.at(3).right.pixels);
  const auto scans = read_all(*drive.velodyne());
  EXPECT_EQ(scans.at(3).start, after(230));
  EXPECT_EQ(scans.at(3).stamp, after(280));
  EXPECT_EQ(scans.at(3).end, after(330));
  EXPECT_EQ(scans.at(3).available, after(330));
  const auto imu = read_all(*drive.imu());
  EXPECT_EQ(imu.at(3).stamp, after(241));
  EXPECT_EQ(imu.at(3).available, after(301));
  const auto fixes = read_all(*drive.gnss());
  EXPECT_EQ(fixes.at(0).stamp, after(1));
  EXPECT_EQ(fixes.at(0).velocity_stamp, after(-59));
  EXPECT_EQ(fixes.at(0).available, after(1));
  const auto reference = read_all(*drive.reference());
  EXPECT_EQ(reference.at(3).stamp, after(301));
  EXPECT_EQ(reference.at(3).velocity_stamp, after(241));
  EXPECT_EQ(reference.at(3).available, after(301));
}

// ---- refused at opening

using Change = std::function<void(const SmallDrive&)>;

Change removed(const std::string& file) {
  return [=](const SmallDrive& drive) { drive.remove(file); };
}
Change written(const std::string& file, const std::string& content) {
  return [=](const SmallDrive& drive) { drive.write(file, content); };
}
Change line(const std::string& file, std::size_t number, const std::string& content) {
  return [=](const SmallDrive& drive) { drive.write_line(file, number, content); };
}

void expect_error(const std::filesystem::path& folder, const std::vector<std::string>& parts) {
  const std::string said = error_of([&] { const KittiDrive drive(folder); });
  for (const std::string& part : parts) EXPECT_THAT(said, HasSubstr(part));
}

TEST(OpeningADrive, NamesAFolderThatIsNotADrive) {
  const SmallDrive small;
  expect_error(small.day() / "nowhere", {"nowhere", "not a folder", "_sync"});
  expect_error("", {"not a folder"});
  expect_error(small.day() / "calib_cam_to_cam.txt", {"not a folder"});
  expect_error(small.day(), {"no folder image_00", "name the drive itself"});
  const maploop::testing::TemporaryFolder empty;
  expect_error(empty.path(), {empty.path().string(), "no folder image_00"});
  const auto extract = small.day() / "2011_09_26_drive_0099_extract";
  std::filesystem::rename(small.folder(), extract);
  expect_error(extract, {"unsynced", "_sync"});
}

TEST(OpeningADrive, NamesAMissingCalibrationFileOrKey) {
  const SmallDrive small;
  small.write_line("../calib_cam_to_cam.txt", 5, "");
  expect_error(small.folder(), {"calib_cam_to_cam.txt", "'R_rect_00'", "missing", "restore"});
  for (const std::string file :
       {"calib_cam_to_cam.txt", "calib_velo_to_cam.txt", "calib_imu_to_velo.txt"}) {
    const SmallDrive other;
    other.remove("../" + file);
    expect_error(other.folder(), {file, "missing", "beside"});
  }
}

TEST(OpeningADrive, NamesATimeStampFileThatIsMissingEmptyOrWithoutStamps) {
  for (const char* file : {"image_00/timestamps.txt", "image_01/timestamps.txt",
                           "velodyne_points/timestamps.txt", "velodyne_points/timestamps_start.txt",
                           "velodyne_points/timestamps_end.txt", "oxts/timestamps.txt"}) {
    const SmallDrive small;
    small.write(file, "");
    expect_error(small.folder(), {file, "no time stamp", "restore"});
    small.write(file, "not one\n");
    expect_error(small.folder(), {file, "no time stamp"});
    small.remove(file);
    expect_error(small.folder(), {file, "missing", "restore"});
  }
}

TEST(OpeningADrive, LidarAndOxtsMayBeAbsentAsAWhole) {
  const SmallDrive small;
  small.remove("velodyne_points");
  small.remove("oxts");
  const KittiDrive drive(small.folder());
  EXPECT_FALSE(drive.has_velodyne() || drive.has_oxts());
  EXPECT_EQ(read_all(*drive.camera()).size(), SmallDrive::frames);
  EXPECT_THROW(drive.velodyne(), std::runtime_error);
  EXPECT_THROW(drive.imu(), std::runtime_error);
  EXPECT_THROW(drive.gnss(), std::runtime_error);
  EXPECT_THROW(drive.reference(), std::runtime_error);
}

TEST(OpeningADrive, RefusesParametersWithoutMeaning) {
  const SmallDrive small;
  for (const auto member :
       {&KittiDriveParameters::imu_delay, &KittiDriveParameters::camera_readout,
        &KittiDriveParameters::max_pair_skew, &KittiDriveParameters::max_turn}) {
    for (const double value : {-0.001, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
      KittiDriveParameters parameters;
      parameters.*member = value;
      EXPECT_THROW(KittiDrive(small.folder(), parameters), std::invalid_argument);
    }
  }
}

// ---- tolerated

TEST(ADriveWithOddities, CrlfFewerDigitsAndBlankLastLinesAreFine) {
  const SmallDrive small;
  const auto to_crlf = [&small](const std::string& file) {
    std::string text = small.read(file);
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) {
      text.replace(at, 1, "\r\n");
    }
    small.write(file, text + "\r\n");
  };
  to_crlf("../calib_cam_to_cam.txt");
  to_crlf("image_00/timestamps.txt");
  to_crlf("oxts/timestamps.txt");
  to_crlf("oxts/data/0000000003.txt");
  small.write_line("image_01/timestamps.txt", 4, "2011-09-26 13:10:51.3");
  const KittiDrive drive(small.folder());
  EXPECT_EQ(drive.frame_count(), SmallDrive::frames);
  EXPECT_EQ(sequences(read_all(*drive.camera())), all);
  EXPECT_EQ(sequences(read_all(*drive.imu())), all);
}

// ---- one sample is left out, and reported

std::string png(int width, int height, std::size_t bytes_a_pixel) {
  const std::vector<std::uint8_t> pixels(bytes_a_pixel * static_cast<std::size_t>(width * height),
                                         9);
  const std::vector<std::uint8_t> file = encode_png(pixels, width, height);
  return {file.begin(), file.end()};
}

std::string jpeg() {
  std::vector<std::uint8_t> file;
  encode_jpeg(std::vector<std::uint8_t>(32 * 24, 9), 32, 24, 90, file);
  return {file.begin(), file.end()};
}

void camera(const KittiDrive& drive, const Sequences& delivered, const Finding& refused) {
  expect_one_refused(drive.camera(), delivered, refused);
}
void velodyne(const KittiDrive& drive, const Sequences& delivered, const Finding& refused) {
  expect_one_refused(drive.velodyne(), delivered, refused);
}
void imu(const KittiDrive& drive, const Sequences& delivered, const Finding& refused) {
  expect_one_refused(drive.imu(), delivered, refused);
}
// A row, as each of the three sources sees it.
void oxts(const KittiDrive& drive, const Sequences& delivered, const Finding& refused) {
  expect_one_refused(drive.imu(), delivered, refused);
  expect_one_refused(drive.reference(), delivered, refused);
  expect_one_refused(drive.gnss(), {0}, refused);
}

const std::string left = "image_00/data/0000000003.png", right = "image_01/data/0000000003.png",
                  stamps = "image_01/timestamps.txt", scan = "velodyne_points/data/0000000003.bin",
                  row = "oxts/data/0000000003.txt";

// Checks what the source does with a drive that was damaged so.
void expect_cost(void (*source)(const KittiDrive&, const Sequences&, const Finding&),
                 const Change& damage, const Finding& refused,
                 const Sequences& delivered = without_3) {
  SCOPED_TRACE(refused.file + ": " + refused.reason);
  const SmallDrive small;
  damage(small);
  source(KittiDrive(small.folder()), delivered, refused);
}

TEST(DamagedCamera, CostsOnePair) {
  expect_cost(camera, removed(left), {left, 0, "missing"});
  expect_cost(camera, removed(right), {right, 0, "missing"});
  const auto folder = [](const SmallDrive& drive) {
    drive.remove(left);
    std::filesystem::create_directory(drive.folder() / left);
  };
  expect_cost(camera, folder, {left, 0, "not a regular file"});
  expect_cost(camera, written(left, png(33, 24, 1)),
              {left, 0, "33 x 24 pixels, but the calibration states 32 x 24"});
  expect_cost(camera, written(left, png(24, 32, 1)), {left, 0, "24 x 32"});
  expect_cost(camera, written(left, png(32, 24, 3)), {left, 0, "not an 8-bit grey image"});
  expect_cost(camera, written(left, jpeg()), {left, 0, "is not a PNG image"});
  expect_cost(camera, written("image_01/data/0000000008.png", png(32, 24, 1)),
              {"0000000008.png", 0, "has no time stamp"}, all);
  const auto shorter = [](const SmallDrive& drive) {
    std::string text = drive.read(stamps);
    text.resize(text.rfind("2011"));
    drive.write(stamps, text);
  };
  expect_cost(camera, shorter, {stamps, 8, "ends before this line"}, {0, 1, 2, 3, 4, 5, 6});
  expect_cost(camera, line(stamps, 4, "2011-09-26 13:1"), {stamps, 4, "not a time stamp"});
  expect_cost(camera, line(stamps, 4, "2011-09-26 13:10:51.34"),
              {stamps, 4, "differs from the left image's stamp by 0.04"});
}

TEST(DamagedVelodyne, CostsOneScan) {
  expect_cost(velodyne, written(scan, std::string(315, 'x')), {scan, 0, "incomplete: 315 bytes"});
  expect_cost(velodyne, written(scan, ""), {scan, 0, "empty"});
  expect_cost(velodyne, removed(scan), {scan, 0, "missing"});
  for (const auto& [file, stamp] :
       {std::pair{"velodyne_points/timestamps_start.txt", "2011-09-26 13:10:51.29"},
        std::pair{"velodyne_points/timestamps_end.txt", "2011-09-26 13:10:51.27"},
        std::pair{"velodyne_points/timestamps_end.txt", "2011-09-26 13:11:51.33"}}) {
    expect_cost(velodyne, line(file, 4, stamp),
                {"velodyne_points/timestamps.txt", 4, "not the stamps of one turn"});
  }
}

TEST(DamagedOxts, CostsOneRow) {
  const std::string good = oxts_row_text();
  std::string nan = good;
  nan.replace(nan.find("-0.43999459306673"), 17, "nan");
  expect_cost(oxts, written(row, nan), {row, 1, "column 12 is not a finite number: 'nan'"});
  expect_cost(oxts, written(row, good.substr(good.find(' '))),
              {row, 1, "29 columns instead of 30"});
  expect_cost(oxts, written(row, ""), {row, 1, "0 columns"});
  expect_cost(oxts, removed(row), {row, 0, "missing"});
  expect_cost(oxts, line("oxts/timestamps.txt", 4, "2011-09-26 13:10:51.201"),  // row 2's
              {"oxts/timestamps.txt", 4, "time does not increase: 2011-09-26 13:10:51.201"});
  const auto more = [&](const SmallDrive& drive) {
    drive.write("oxts/data/0000000012.txt", good);
    drive.write("oxts/data/notes.txt", "not a row");
  };
  expect_cost(imu, more, {"oxts/data/0000000012.txt", 0, "has no time stamp"}, all);
}

TEST(DamagedCamera, ACutImageAtAnyLength) {
  const SmallDrive small;
  const std::string whole = small.read(right);
  const KittiDrive drive(small.folder());
  // The last 12 bytes only mark the end of the image.
  for (std::size_t length = 0; length + 12 < whole.size(); length += 1 + whole.size() / 50) {
    small.write(right, whole.substr(0, length));
    camera(drive, without_3,
           {right, 0,
            length == 0  ? "empty"
            : length < 8 ? "is not a PNG image"
                         : "incomplete or damaged"});
  }
}

TEST(DamagedCamera, FewerFilesThanStamps) {
  const SmallDrive small;
  for (int i = 5; i < 8; ++i) {
    small.remove("image_00/data/000000000" + std::to_string(i) + ".png");
  }
  auto camera = KittiDrive(small.folder()).camera();
  EXPECT_EQ(sequences(read_all(*camera)), (Sequences{0, 1, 2, 3, 4}));
  ASSERT_EQ(camera->report().refused, 3U);
  expect_finding(camera->report().refusals[2], {"image_00/data/0000000007.png", 0, "missing"});
}

TEST(DamagedVelodyne, PointsThatAreNotFiniteAreDroppedAndCounted) {
  const SmallDrive small;
  std::string points = small.read(scan);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(&points[16 * 4 + 8], &nan, sizeof(nan));
  std::memcpy(&points[16 * 9 + 12], &nan, sizeof(nan));
  small.write(scan, points);
  auto velodyne = KittiDrive(small.folder()).velodyne();
  const auto scans = read_all(*velodyne);
  ASSERT_EQ(sequences(scans), all);
  EXPECT_EQ(scans[3].points.size(), SmallDrive::points - 2);
  EXPECT_EQ(scans[4].points.size(), SmallDrive::points);
  EXPECT_EQ(velodyne->report().refused, 0U);
  EXPECT_EQ(velodyne->report().flawed, 1U);
  expect_finding(velodyne->report().flaws.at(0), {scan, 0, "2 of 20 points are not finite"});
}

TEST(DamagedVelodyne, FewerScansThanStampsAsInSomeOfKittisDrives) {
  const SmallDrive small;
  small.remove("velodyne_points/data");
  auto velodyne = KittiDrive(small.folder()).velodyne();
  LidarScan scan;
  EXPECT_FALSE(velodyne->next(scan));
  EXPECT_EQ(velodyne->report().refused, SmallDrive::frames);
}

TEST(DamagedOxts, ReversedStampsLeaveOneSampleAndAreReported) {
  const SmallDrive small;
  std::string reversed;
  for (int i = 8; i > 0; --i) reversed += "2011-09-26 13:10:51." + std::to_string(i) + "\n";
  small.write("oxts/timestamps.txt", reversed);
  auto imu = KittiDrive(small.folder()).imu();
  EXPECT_EQ(read_all(*imu).size(), 1U);
  EXPECT_EQ(imu->report().refused, 7U);
}

TEST(DamagedOxts, AGnssRowThatIsRefusedIsReplacedByTheNext) {
  const SmallDrive small;
  small.write("oxts/data/0000000000.txt", "");
  auto gnss = KittiDrive(small.folder()).gnss();
  const auto fixes = read_all(*gnss);
  ASSERT_EQ(fixes.size(), 1U);
  EXPECT_EQ(fixes[0].stamp, parse_time("2011-09-26 13:10:51.101"));
  EXPECT_EQ(gnss->report().refused, 1U);
}

// ---- the report stays small

TEST(SourceReport, CountsAllButKeepsOnlyTheFirst) {
  SourceReport report;
  for (int i = 0; i < 1000; ++i) report.refuse({std::to_string(i), 0, ""});
  EXPECT_EQ(report.refused, 1000U);
  ASSERT_EQ(report.refusals.size(), SourceReport::max_findings);
  EXPECT_EQ(report.refusals.back().file, "99");
}

// ---- the same on copies of the real drive's files

TEST(DamagedRealFiles, CutImageAndScanOfTheRealDrive) {
  MAPLOOP_REQUIRE_DRIVE();
  const SmallDrive small;
  const auto real = maploop::testing::drive_0013();
  std::filesystem::copy_file(real.parent_path() / "calib_cam_to_cam.txt",
                             small.day() / "calib_cam_to_cam.txt",
                             std::filesystem::copy_options::overwrite_existing);
  for (const char* sensor : {"image_00", "image_01", "velodyne_points"}) {
    small.remove(std::string(sensor) + "/data");
    std::filesystem::create_directory(small.folder() / sensor / "data");
    for (const char* frame : {"0000000000", "0000000001", "0000000002"}) {
      const std::string name = std::string(sensor) + "/data/" + frame +
                               (std::string(sensor) == "velodyne_points" ? ".bin" : ".png");
      std::filesystem::copy_file(real / name, small.folder() / name);
      std::filesystem::permissions(small.folder() / name, std::filesystem::perms::owner_all);
    }
  }
  const auto cut = [&small](const std::string& file, std::uintmax_t bytes) {
    std::filesystem::resize_file(small.folder() / file,
                                 std::filesystem::file_size(small.folder() / file) - bytes);
  };
  cut("image_01/data/0000000001.png", 50000);
  cut("velodyne_points/data/0000000001.bin", 50001);
  const KittiDrive drive(small.folder());
  auto camera = drive.camera();
  EXPECT_EQ(sequences(read_all(*camera)), (Sequences{0, 2}));
  expect_finding(camera->report().refusals.at(0),
                 {"image_01/data/0000000001.png", 0, "incomplete or damaged"});
  auto velodyne = drive.velodyne();
  EXPECT_EQ(sequences(read_all(*velodyne)), (Sequences{0, 2}));
  expect_finding(velodyne->report().refusals.at(0), {"0000000001.bin", 0, "incomplete"});
}

}  // namespace
}  // namespace maploop::sensors
