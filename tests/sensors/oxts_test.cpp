#include "sensors/replay/oxts.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/sensors/small_drive.h"
#include "tests/support/error_of.h"

namespace maploop::sensors {
namespace {

using ::testing::HasSubstr;

std::string error_in(const std::string& text) {
  return maploop::testing::error_of<std::invalid_argument>([&] { parse_oxts_row(text); });
}

// Returns a row whose column i (from 0) is i / 16, except for the attitude.
std::string numbered_row(const std::string& roll, const std::string& pitch,
                         const std::string& yaw) {
  std::ostringstream text;
  text << "0 0.0625 0.125 " << roll << ' ' << pitch << ' ' << yaw;
  for (int i = 6; i < 30; ++i) text << ' ' << i / 16.0;
  return text.str();
}

TEST(OxtsRow, TakesTheBodysOwnAxesAndNeverTheLevelledOnes) {
  const OxtsRow row = parse_oxts_row(numbered_row("0", "0", "0"));
  // ax, ay, wz, az, wx, wy; not af, al, au (14 to 16) and wf, wl, wu (20 to 22)
  const InertialValues own{11 / 16.0, 12 / 16.0, 19 / 16.0, true, 13 / 16.0, 17 / 16.0, 18 / 16.0};
  EXPECT_EQ(row.inertial, own);
}

TEST(OxtsRow, PositionVelocityAndAccuracy) {
  const OxtsRow row = parse_oxts_row(numbered_row("0", "0", "0"));
  EXPECT_EQ(row.position.latitude, 0.0);
  EXPECT_DOUBLE_EQ(row.position.longitude, radians(1 / 16.0));
  EXPECT_EQ(row.position.height, 2 / 16.0);
  EXPECT_EQ(row.velocity_enu * 16.0, Eigen::Vector3d(7, 6, 10));  // the file has vn before ve
  EXPECT_EQ(row.position_accuracy, 23 / 16.0);
}

// KITTI defines R = Rz(yaw) Ry(pitch) Rx(roll), nose down for a positive pitch.
TEST(OxtsRow, AttitudeIsTheRotationThatKittiDefines) {
  const double roll = 0.2, pitch = -0.3, yaw = 2.9;
  const Eigen::Matrix3d kitti = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                                    .toRotationMatrix();
  const Attitude attitude = parse_oxts_row(numbered_row("0.2", "-0.3", "2.9")).attitude;
  EXPECT_LT((rotation_enu_body(attitude) - kitti).norm(), 1e-14);
  EXPECT_EQ(attitude.pitch, 0.3);  // nose up
  EXPECT_EQ(attitude.roll, 0.2);   // left side up is right side down
}

TEST(OxtsRow, EastIsAzimuthNinetyDegreesAndNorthIsZero) {
  EXPECT_NEAR(parse_oxts_row(numbered_row("0", "0", "0")).attitude.azimuth, radians(90.0), 1e-15);
  EXPECT_NEAR(parse_oxts_row(numbered_row("0", "0", "1.570796326794897")).attitude.azimuth, 0.0,
              1e-15);
}

TEST(OxtsRow, RefusesWhatIsNotThirtyFiniteNumbers) {
  const std::string row = oxts_row_text();
  EXPECT_THAT(error_in(""), HasSubstr("0 columns instead of 30"));
  EXPECT_THAT(error_in(row.substr(0, row.rfind(' '))), HasSubstr("29 columns"));
  EXPECT_THAT(error_in(row + " 1"), HasSubstr("31 columns"));
  EXPECT_THAT(error_in(row + row), HasSubstr("60 columns"));
  for (const char* bad : {"nan", "-inf", "1e999", "0x10", "1,5", "--1", "1.2.3"}) {
    const std::string error = error_in(std::string(bad) + row.substr(row.find(' ')));
    EXPECT_THAT(error, HasSubstr(std::string("column 1 is not a finite number: '") + bad));
  }
}

TEST(OxtsRow, RefusesWhatIsOutsideTheRangeOfItsKind) {
  EXPECT_THAT(error_in(numbered_row("4", "0", "0")), HasSubstr("roll"));
  EXPECT_THAT(error_in(numbered_row("0", "1.7", "0")), HasSubstr("pitch"));
  EXPECT_THAT(error_in(numbered_row("0", "0", "-3.2")), HasSubstr("yaw"));
  std::string row = oxts_row_text();
  row[0] = '9';  // 99 degrees north
  EXPECT_THAT(error_in(row), HasSubstr("lat is out of range: 99.01"));
  row = oxts_row_text();
  row.erase(row.find("11.375996992995") + 2, 1);  // the decimal point of vn
  EXPECT_THAT(error_in(row), HasSubstr("vn"));
}

TEST(OxtsRow, AcceptsTabsSignsAndCrlf) {
  std::string row = oxts_row_text();
  row[row.find(' ')] = '\t';
  EXPECT_EQ(parse_oxts_row(std::string("+").append(row).append("\r\n")).position.height,
            114.06644439697);
}

}  // namespace
}  // namespace maploop::sensors
