// These tests run the parsers on thousands of damaged copies of real files. The result must be an
// error or a counted refusal, or else be usable.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include "msgs/frames.h"
#include "sensors/image/png.h"
#include "sensors/replay/files.h"
#include "sensors/replay/kitti_calibration.h"
#include "sensors/replay/oxts.h"
#include "sensors/replay/timestamps.h"
#include "tests/sensors/small_drive.h"
#include "tests/support/damaged_text.h"

namespace maploop::sensors {
namespace {

constexpr std::string_view alphabet("0123456789.-+eE:naif \n\r\t", 25);  // and a zero

struct Tally {
  int accepted = 0, refused = 0;
};

// Any error other than those that a parser promises fails the test.
template <class Error>
Tally feed(const std::string& text, int rounds, const std::function<void(const std::string&)>& f) {
  std::mt19937 random(20110926);
  Tally tally;
  for (int round = 0; round < rounds; ++round) {
    try {
      f(maploop::testing::damaged(text, random, 40, alphabet));
      ++tally.accepted;
    } catch (const Error& error) {
      EXPECT_GT(std::string(error.what()).size(), 5U);
      ++tally.refused;
    }
  }
  return tally;
}

TEST(DamagedText, Timestamps) {
  MAPLOOP_REQUIRE_DRIVE();
  const std::string text = read_text(maploop::testing::drive_0013() / "oxts/timestamps.txt");
  std::size_t refused_lines = 0;
  const Tally tally = feed<std::runtime_error>(text, 4000, [&](const std::string& damaged_text) {
    Timestamps t = parse_timestamps(damaged_text, "stamps.txt");
    ASSERT_EQ(t.stamps.size(), t.verdicts.size());
    refuse_out_of_order(t.stamps, t.file, t.verdicts);
    std::optional<Time> last;
    for (std::size_t i = 0; i < t.size(); ++i) {
      if (t.verdicts[i]) {
        ++refused_lines;
      } else {
        ASSERT_TRUE(!last || *last < t.stamps[i]);
        last = t.stamps[i];
      }
    }
  });
  EXPECT_GT(tally.accepted, 3500);
  EXPECT_GT(refused_lines, 2000U);
}

TEST(DamagedText, AnyWhiteSpaceSeparatesNumbers) {
  EXPECT_EQ(parse_numbers("\v1 \t2\f\v3\r\n"), (std::vector<double>{1.0, 2.0, 3.0}));
  EXPECT_TRUE(parse_numbers(" \f\v").empty());
}

TEST(DamagedText, OxtsRow) {
  MAPLOOP_REQUIRE_DRIVE();
  const std::string text = read_text(maploop::testing::drive_0013() / "oxts/data/0000000072.txt");
  const Tally tally = feed<std::invalid_argument>(text, 8000, [](const std::string& row_text) {
    const OxtsRow row = parse_oxts_row(row_text);
    EXPECT_TRUE(row.velocity_enu.allFinite());
    EXPECT_TRUE(std::isfinite(row.inertial.yaw_rate) && std::isfinite(row.inertial.roll_rate) &&
                std::isfinite(row.inertial.specific_force_forward));
    EXPECT_TRUE(rotation_enu_body(row.attitude).allFinite());
  });
  EXPECT_GT(tally.refused, 3000);
  EXPECT_GT(tally.accepted, 500);  // a changed digit is still a number
}

TEST(DamagedText, Calibration) {
  MAPLOOP_REQUIRE_DRIVE();
  const auto day = maploop::testing::drive_0013().parent_path();
  const std::string cameras = read_text(day / "calib_cam_to_cam.txt");
  const std::string velo = read_text(day / "calib_velo_to_cam.txt");
  const std::string imu = read_text(day / "calib_imu_to_velo.txt");
  const auto parse = [](const std::string& c, const std::string& v, const std::string& i) {
    const VehicleCalibration calibration =
        parse_kitti_calibration({c, v, i, "cams.txt", "velo.txt", "imu.txt"});
    for (const Eigen::Isometry3d& T : {calibration.stereo.T_body_cam, calibration.T_body_velo}) {
      EXPECT_TRUE(T.matrix().allFinite());
      EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-9);
    }
    EXPECT_GT(calibration.stereo.width, 0);
    EXPECT_GT(calibration.stereo.baseline, 0.0);
  };
  feed<std::runtime_error>(cameras, 3000, [&](const std::string& t) { parse(t, velo, imu); });
  const Tally a =
      feed<std::runtime_error>(velo, 3000, [&](const std::string& t) { parse(cameras, t, imu); });
  const Tally b =
      feed<std::runtime_error>(imu, 3000, [&](const std::string& t) { parse(cameras, velo, t); });
  EXPECT_GT(a.refused, 500);
  EXPECT_GT(b.refused, 500);
}

TEST(DamagedImage, RealPng) {
  MAPLOOP_REQUIRE_DRIVE();
  const std::string png =
      read_text(maploop::testing::drive_0013() / "image_00/data/0000000000.png");
  GreyImage whole, image;
  decode_grey_png(png, 1242, 375, whole);
  // The checksums protect the pixels: an accepted file shows them all.
  const Tally tally = feed<std::runtime_error>(png, 150, [&](const std::string& bytes) {
    decode_grey_png(bytes, 1242, 375, image);
    EXPECT_EQ(image.pixels, whole.pixels);
  });
  EXPECT_GT(tally.refused, 100);
}

}  // namespace
}  // namespace maploop::sensors
