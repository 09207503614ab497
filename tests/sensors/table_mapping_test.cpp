// These tests read tables whose columns, units and axes a mapping names.
#include "sensors/folder/table_mapping.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "msgs/frames.h"
#include "msgs/input_file.h"
#include "sensors/folder/number_table.h"
#include "sensors/folder/table_recording.h"
#include "tests/sensors/folder_forms.h"
#include "tests/sensors/small_drive.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

using maploop::testing::error_of;
using maploop::testing::write_text;
using ::testing::HasSubstr;

class Mapped : public ::testing::Test {
 protected:
  Mapped() {
    mapping_.imu.file = folder_.path() / "imu.csv";
    mapping_.imu.time = {"t [ms]"};
    mapping_.imu.time_unit = TimeUnit::ms;
    mapping_.imu.gyro = {{"gx", "gy", "gz"}, radians(1.0)};
    mapping_.imu.accelerometer = {{"ax", "ay", "az"}, 9.80665};
    mapping_.gnss.file = folder_.path() / "gnss.csv";
    mapping_.gnss.time = {"t"};
    mapping_.gnss.position = {{"a", "b", "c"}};
  }
  void imu(const std::string& text) const { write_text(mapping_.imu.file, text); }
  void gnss(const std::string& text) const { write_text(mapping_.gnss.file, text); }
  std::vector<GnssFix> fixes() {
    mapping_.imu.file.clear();
    return read_all(*TableRecording(mapping_).gnss());
  }
  std::vector<ImuSample> samples() {
    mapping_.gnss.file.clear();
    return read_all(
        std::unique_ptr<Source<ImuSample>>(TableRecording(mapping_).imu(nullptr, {true}, 0.0)));
  }

  maploop::testing::TemporaryFolder folder_;
  TableMapping mapping_;
};

TEST_F(Mapped, UnitsAreThoseOfTheColumns) {
  imu("gz;gy;gx;ax;ay;az;t [ms];other\n90;0;0;0.5;-1;1;1600000000123;7\n");
  const auto found = samples();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].stamp, Time(std::chrono::milliseconds(1600000000123)));
  EXPECT_DOUBLE_EQ(found[0].yaw_rate, radians(90.0));
  EXPECT_DOUBLE_EQ(found[0].specific_force_forward, 0.5 * 9.80665);
}

TEST_F(Mapped, NanosecondsAreExact) {
  mapping_.imu.time_unit = TimeUnit::ns;
  mapping_.imu.columns = {"t [ms]", "gx", "gy", "gz", "ax", "ay", "az"};
  imu("#a comment\n1403636579763555584,0,0,0,0,0,1\n1403636579763555585,0,0,0,0,0,1\n");
  const auto found = samples();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(to_nanoseconds(found[0].stamp), 1403636579763555584);
  EXPECT_EQ(to_nanoseconds(found[1].stamp), 1403636579763555585);
}

TEST_F(Mapped, GpsWeeksLoseTheirLeapSeconds) {
  mapping_.gnss.time = {"week", "tow"};
  mapping_.gnss.time_unit = TimeUnit::gps_week;
  mapping_.utc_of_gps = [](Time gps) { return gps - std::chrono::seconds(18); };
  gnss("week tow a b c\n2056 547435.5 47 -1.35 84\n");
  EXPECT_EQ(fixes().at(0).stamp, parse_time("2019-06-08 08:03:37.5"));
}

TEST_F(Mapped, EcefBecomesGeodetic) {
  mapping_.gnss.form = PositionForm::ecef;
  mapping_.gnss.velocity = {{"vx", "vy", "vz"}};
  mapping_.gnss.velocity_axes = VelocityAxes::ecef;
  // 49 deg north, 8.4 deg east, 115 m: by PROJ's cct.
  gnss("t,a,b,c,vx,vy,vz\n1,4147349.4158,612421.6098,4790494.3021,0,0,1\n");
  const GnssFix fix = fixes().at(0);
  const Eigen::Vector3d p(4147349.4158, 612421.6098, 4790494.3021);
  const double e2 = 6.69437999014e-3, a = 6378137.0, s = std::sin(fix.position.latitude);
  const double n = a / std::sqrt(1.0 - e2 * s * s), h = fix.position.height;
  const double c = std::cos(fix.position.latitude);
  EXPECT_NEAR((n + h) * c * std::cos(fix.position.longitude), p.x(), 1e-3);
  EXPECT_NEAR((n + h) * c * std::sin(fix.position.longitude), p.y(), 1e-3);
  EXPECT_NEAR((n * (1.0 - e2) + h) * s, p.z(), 1e-3);
  EXPECT_NEAR(fix.velocity_enu.y(), c, 1e-12);
  EXPECT_NEAR(fix.velocity_enu.z(), s, 1e-12);
}

TEST_F(Mapped, VelocitiesHaveTheirAxesOrFollowFromThePositions) {
  mapping_.gnss.velocity = {{"v1", "v2", "v3"}, 1.0 / 3.6};
  mapping_.gnss.velocity_axes = VelocityAxes::enu;
  gnss("t,a,b,c,v1,v2,v3\n1,49,8,100,36,72,3.6\n");
  EXPECT_TRUE(fixes().at(0).velocity_enu.isApprox(Eigen::Vector3d(10, 20, 1)));
  mapping_.gnss.velocity = {};
  gnss("t,a,b,c\n1,49.00000,8,100\n2,49.00001,8,100\n3,49.00002,8,100\n4,49.00003,8,100\n");
  const auto found = fixes();
  EXPECT_EQ(found.at(0).velocity_covariance(0, 0), 1e4);
  EXPECT_NEAR(found.at(3).velocity_enu.y(), 1.112, 0.01);
  EXPECT_LT(found.at(3).velocity_covariance(0, 0), 1.0);
  EXPECT_NEAR(found.at(3).position_covariance(0, 0), 9.0, 1e-12);
}

TEST_F(Mapped, RowsThatLackAValueAreLeftOut) {
  gnss("t,a,b,c\n1,49,8,100\n2,nan,8,100\n3,,8,100\n4,49,8,100\n");
  mapping_.imu.file.clear();
  const auto source = TableRecording(mapping_).gnss();
  EXPECT_EQ(read_all(*source).size(), 2U);
  ASSERT_EQ(source->report().refused, 2U);
  EXPECT_EQ(source->report().refusals[0].line, 3U);
  EXPECT_THAT(source->report().refusals[0].reason, HasSubstr("a is out of range"));
}

TEST_F(Mapped, WheelsAndAReferenceAreRead) {
  mapping_ = {};
  mapping_.wheel.file = mapping_.reference.file = folder_.path() / "odometer.csv";
  mapping_.wheel.time = mapping_.reference.time = {"t"};
  mapping_.wheel.speed = {{"v"}, 1.0 / 3.6};
  mapping_.reference.form = PositionForm::local;
  mapping_.reference.position = {{"x", "y", "z"}};
  mapping_.reference.attitude = {{"r", "p", "h"}, degrees(1.0)};
  write_text(mapping_.wheel.file, "t,v,x,y,z,r,p,h\n1,36,1,2,3,0.1,0.2,0.3\n");
  const TableRecording tables(mapping_);
  EXPECT_DOUBLE_EQ(read_all(*tables.wheel()).at(0).speed, 10.0);
  const ReferencePose pose = read_all(*tables.reference()).at(0);
  EXPECT_NEAR(pose.attitude.azimuth, 0.3, 1e-12);
  EXPECT_NEAR(pose.attitude.pitch, 0.2, 1e-12);
  EXPECT_TRUE(LocalFrame().to_enu(pose.position).isApprox(Eigen::Vector3d(1, 2, 3), 1e-6));
  EXPECT_FALSE(tables.has_gnss());
}

// ---- RTKLIB

constexpr const char* pos_text =
    "% program   : RTKLIB ver.demo5 b31\n% (lat/lon/height=WGS84/ellipsoidal,Q=1:fix)\n"
    "%  GPST                  latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)   "
    "sdu(m)  sdne(m)  sdeu(m)  sdun(m) age(s)  ratio\n"
    "2019/06/08 08:03:55.500   47.060027749   -1.350495019    84.8600   1   7   0.0100   0.0200   "
    "0.0300   0.0000   0.0000   0.0000   0.50   99.9\n";

TEST(RtklibsSolutions, HaveTheColumnsOfTheirHeading) {
  const NumberCells cells = parse_pos(pos_text);
  ASSERT_EQ(cells.columns.size(), 14U);
  EXPECT_EQ(cells.columns[0], "GPST");
  EXPECT_EQ(cells.columns[3], "height");
  EXPECT_EQ(cells.values[0], to_seconds(parse_time("2019-06-08 08:03:55.5").time_since_epoch()));
  EXPECT_EQ(cells.values[8], 0.03);
  const std::string text = pos_text;
  const auto week =
      text.substr(0, text.find("2019")) + "2056 547435.5" + text.substr(text.find(".500  ") + 4);
  EXPECT_EQ(parse_pos(week).values[0], cells.values[0]);
  const auto refusal = [](const std::string& content) {
    return error_of<std::invalid_argument>([&] { parse_pos(content); });
  };
  EXPECT_THAT(refusal("1 2 3\n"), HasSubstr("line 1: has no heading"));
  EXPECT_THAT(refusal("%\n"), HasSubstr("no heading of RTKLIB"));
  EXPECT_THAT(refusal(text + "2019/06/08 08:03:56.500 47.0\n"), HasSubstr("line 5: has 3 words"));
  EXPECT_THAT(
      refusal(text.substr(0, text.find("2019")) + "x y" + text.substr(text.find(".500  ") + 4)),
      HasSubstr("neither a date"));
}

// ---- NumPy

std::string npy(const std::string& header, const void* data, std::size_t size) {
  std::string text("\x93NUMPY\x01\x00", 8);
  text += static_cast<char>(header.size() & 0xFF);
  text += static_cast<char>(header.size() >> 8);
  return text + header + std::string(static_cast<const char*>(data), size);
}

TEST(NumpysArrays, OfTwoDimensionsHaveNamedColumns) {
  const double values[6] = {1, 2, 3, 4, 5, 6};
  const NumberTableOptions options{{"a", "b", "c"}, "a", true};
  const auto rows = parse_npy(
      npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }\n", values, 48), options);
  EXPECT_EQ(rows.values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  const auto columns = parse_npy(
      npy("{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3), }\n", values, 48), options);
  EXPECT_EQ(columns.values, (std::vector<double>{1, 3, 5, 2, 4, 6}));
}

TEST(NumpysArrays, OfNamedFieldsKeepWholeNumbersAndOrders) {
  struct [[gnu::packed]] Row {
    std::int64_t t;
    float x;
    std::uint16_t n;
  };
  const Row rows[2] = {{1403636579763555584, 1.5F, 0x0201}, {1403636579763555585, -2.5F, 0x0403}};
  const auto cells = parse_npy(
      npy("{'descr': [('t', '<i8'), ('x', '<f4'), ('n', '>u2')], 'fortran_order': False, 'shape': "
          "(2,), }\n",
          rows, sizeof rows),
      {{}, "t", true});
  EXPECT_EQ(cells.columns, (std::vector<std::string>{"t", "x", "n"}));
  EXPECT_EQ(cells.whole, (std::vector<std::int64_t>{1403636579763555584, 1403636579763555585}));
  EXPECT_EQ(cells.values[4], -2.5);
  EXPECT_EQ(cells.values[2], 0x0102);
}

TEST(NumpysArrays, BrokenOnesAreNamed) {
  struct Case {
    std::string content;
    const char* says;
  };
  const double values[2] = {1, 2};
  const auto header = [&](const std::string& text) { return npy(text, values, 16); };
  for (const Case& c : std::initializer_list<Case>{
           {"", "is not a .npy"},
           {std::string("\x93NUMPY\x01\x00\xFF\xFF", 10), "is not a .npy"},
           {std::string("\x93NUMPY\x01\x00\xFF\xFF{'de", 14), "header is cut"},
           {header("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }"), "1 dimensions"},
           {header("{'descr': '|O', 'fortran_order': False, 'shape': (1, 2), }"), "the type '|O'"},
           {header("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 3), }"), "3 columns"},
           {header("{'descr': '<f8', 'fortran_order': False, 'shape': (9, 2), }"), "9 rows"},
           {header("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999, 2), }"),
            "rows"},
           {header("{'descr': '<f8', 'fortran_order': False, 'shape': (x, 2), }"), "not numbers"},
           {header("{'descr': [('a', '<f8', (3,))], 'fortran_order': False, 'shape': (1,), }"),
            "'a' is an array"},
           {header("{'fortran_order': False, 'shape': (1, 2), }"), "no 'descr'"}}) {
    EXPECT_THAT(error_of<std::invalid_argument>([&] {
                  parse_npy(c.content, {{"a", "b"}, {}, true});
                }),
                HasSubstr(c.says));
  }
}

}  // namespace
}  // namespace maploop::sensors
