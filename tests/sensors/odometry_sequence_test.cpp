// These tests replay KITTI's odometry sequences, and check what is made of their rows.
#include "sensors/replay/odometry_sequence.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <fstream>

#include "sensors/folder/number_table.h"
#include "sensors/replay/imu_noise.h"
#include "tests/sensors/small_drive.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

using maploop::testing::error_of;
using ::testing::HasSubstr;

namespace fs = std::filesystem;
using maploop::testing::real_data;

fs::path sequence(const std::string& name) {
  return real_data() / "kitti_odometry" / "oxts" / (name + ".csv.gz");
}

TEST(OdometrySequence, LeavesOutWhatTheRecorderInvented) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const OdometrySequence six(sequence("06"), {});
  EXPECT_EQ(six.frame_count(), 1101u);
  const auto reference = read_all(six.reference());
  ASSERT_EQ(reference.size(), 1101u - 12u);  // rows 0 to 11; row 12 is real
  EXPECT_EQ(reference.front().sequence, 12u);
  const auto source = six.imu();
  read_all(source);
  EXPECT_EQ(source->report().refused, 12u);
}

TEST(OdometrySequence, RatesAreStampedBeforeTheirRows) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const OdometrySequence six(sequence("06"), {});
  const ImuSample first = read_all(six.imu()).front();
  EXPECT_EQ(first.available - first.stamp, std::chrono::milliseconds(60));
  const ReferencePose pose = read_all(six.reference()).front();
  EXPECT_EQ(pose.stamp, first.available);
}

TEST(OdometrySequence, HasTracksAndFastImuWhereTheyWereRecorded) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const OdometrySequence six(sequence("06"), {}), zero(sequence("00"), {}),
      four(sequence("04"), {});
  ASSERT_TRUE(six.tracks_file());
  EXPECT_EQ(six.tracks_file()->filename(), "2011_09_30_drive_0020.csv.gz");
  EXPECT_FALSE(zero.tracks_file());
  EXPECT_GT(read_all(zero.imu()).size(), 45'000u);
  EXPECT_EQ(read_all(four.imu()).size(), 271u);
}

TEST(OdometrySequence, IsNamedByItsTableOrItsNumber) {
  MAPLOOP_REQUIRE_REAL_DATA();
  EXPECT_TRUE(OdometrySequence::is_named(sequence("06")));
  EXPECT_TRUE(OdometrySequence::is_named(real_data() / "kitti_odometry" / "06"));
  EXPECT_FALSE(OdometrySequence::is_named(real_data() / "kitti_odometry" / "05"));
  EXPECT_FALSE(OdometrySequence::is_named(real_data()));
}

class FreeSequence : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder.path() / name).parent_path());
    std::ofstream(folder.path() / name) << text;
  }
  void write_table(const std::string& name, const std::vector<std::string>& times) const {
    std::string text = "t";
    for (int i = 0; i < 29; ++i) text += ",c" + std::to_string(i);
    text += ",orimode\n";
    for (const std::string& t : times) {
      text += t + ",49.0,8.4,112,0,0,0";
      for (int k = 0; k < 24; ++k) text += ",0.5";
      text += "\n";
    }
    write(name, text);
  }
  OdometrySequence opened(const std::string& name) const { return {folder.path() / name, {}}; }

  const std::vector<std::string> five{"0", "0.1", "0.2", "0.3", "0.4"};
  maploop::testing::TemporaryFolder folder;
};

// This is a sequence of three rows in the layout of KITTI's recording.
class SmallSequence : public FreeSequence {
 protected:
  SmallSequence() {
    write_table("oxts/04.csv", {"0", "0.1", "1e300"});
    write("poses/04.times.txt", "0\n0.1\n");
  }
  std::string refusal() const {
    return error_of([&] { opened("oxts/04.csv"); });
  }
};

TEST_F(SmallSequence, LeavesOutARowWithAnInvalidStamp) {
  const auto source = opened("oxts/04.csv").imu();
  read_all(source);
  EXPECT_EQ(source->report().delivered, 2u);
  ASSERT_EQ(source->report().refusals.size(), 1u);
  EXPECT_EQ(source->report().refusals[0].line, 4u);
}

TEST_F(SmallSequence, RefusesGapsThatHaveNoLastRow) {
  write("oxts/04.gaps.csv", "first_row\n1\n");
  EXPECT_THAT(refusal(), HasSubstr("04.gaps.csv: has no column 'last_row'"));
  write("oxts/04.gaps.csv", "first_row,last_row\n-1e300,1e300\n");
  EXPECT_EQ(refusal(), "");
}

TEST_F(SmallSequence, RefusesImagesAtNoTime) {
  write("poses/04.times.txt", "0\n1e300\n");
  EXPECT_THAT(refusal(), HasSubstr("04.times.txt:2: "));
}

TEST_F(FreeSequence, NeedsNothingButItsTable) {
  write_table("a/my drive.csv", five);
  const OdometrySequence drive = opened("a/my drive.csv");
  EXPECT_EQ(drive.frame_count(), 5u);
  EXPECT_EQ(drive.first_stamp(), parse_time("2000-01-01 00:00:00"));
  EXPECT_FALSE(drive.tracks_file());
  EXPECT_FALSE(drive.labels_file());
  EXPECT_EQ(read_all(drive.imu()).size(), 5u);
}

TEST_F(FreeSequence, TakesTimesSince1970AsTheyAre) {
  write_table("drive.csv", {"1317042651", "1317042651.1"});
  EXPECT_EQ(opened("drive.csv").first_stamp(), parse_time("2011-09-26 13:10:51"));
}

TEST_F(FreeSequence, UsesWhatLiesBesideIt) {
  write_table("x/07.csv", five);
  write("x/07.times.txt", "0.01\n0.11\n0.21\n");
  write("x/07.gaps.csv", "first_row,last_row\n1,3\n");
  write("x/07.labels.csv", "frame\n");
  write("x/07.imu.csv", "t,ax,ay,wz,interpolated\n0,0,0,0,0\n0.01,0,0,0,1\n0.02,0,0,0,0\n");
  write("sequences.csv", "name,start,imu,tracks\n07,2020-02-03 04:05:06,,x/tracks.csv\n");
  write("x/tracks.csv", "");
  const OdometrySequence drive = opened("x/07.csv");
  EXPECT_EQ(drive.frame_count(), 3u);
  EXPECT_EQ(drive.first_stamp(), parse_time("2020-02-03 04:05:06.01"));
  EXPECT_EQ(read_all(drive.reference()).size(), 4u) << "row 2 is within the gap";
  EXPECT_EQ(read_all(drive.imu()).size(), 2u);
  EXPECT_EQ(drive.labels_file()->filename(), "07.labels.csv");
  EXPECT_EQ(drive.tracks_file()->filename(), "tracks.csv");
}

TEST_F(FreeSequence, AnInvalidListIsNamed) {
  write_table("x/07.csv", five);
  write("x/sequences.csv", "name,start\n07,2020-02-03\n");
  EXPECT_THAT(error_of([&] { opened("x/07.csv"); }),
              HasSubstr("sequences.csv:1: the columns must be name,start,imu,tracks"));
}

TEST_F(FreeSequence, AnotherTableIsNone) {
  write("track.csv", "t,lat,lon\n0,49,8\n");
  EXPECT_FALSE(OdometrySequence::is_named(folder.path() / "track.csv"));
  EXPECT_FALSE(OdometrySequence::is_named(folder.path()));
}

TEST(WheelOdometer, HasTheScaleErrorAndTheNoiseItIsAskedFor) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const OdometrySequence four(sequence("04"), {});
  const auto exact = read_all(four.wheel({.scale_error = 0.0, .white_speed = 0.0, .seed = 1}));
  const auto noisy = read_all(four.wheel({.scale_error = 0.01, .white_speed = 0.05, .seed = 1}));
  ASSERT_EQ(exact.size(), 271u);
  double mean = 0.0, variance = 0.0, way = 0.0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double error = noisy[i].speed - exact[i].speed;
    mean += error / 271.0;
    way += exact[i].speed / 271.0;
    const double white = error - 0.01 * exact[i].speed;
    variance += white * white / 271.0;
  }
  EXPECT_NEAR(mean / way, 0.01, 0.001);
  EXPECT_NEAR(std::sqrt(variance), 0.05, 0.007);
  EXPECT_THROW(four.wheel({.scale_error = 2.0}), std::invalid_argument);
  EXPECT_THROW(four.wheel({.white_speed = -1.0}), std::invalid_argument);
}

constexpr double earth = 6.378e6;  // m, about

WheelSpeed wheels(const WheelOdometer& odometer, double force, double east = 0.0) {
  WheelSpeed sample;
  const Geodetic place{0.85, 0.14 + east / (earth * std::cos(0.85)), 100.0};
  odometer.measure(parse_time("2011-09-26 13:00:00"), 10.0, force, place, sample);
  return sample;
}

TEST(WheelOdometer, SlipsWithTheForceThatItsTyresCarry) {
  const WheelOdometer odometer({.white_speed = 0.0, .slip = 0.01});
  EXPECT_EQ(wheels(odometer, 0.0).speed, 10.0);
  EXPECT_NEAR(wheels(odometer, 2.0).speed, 10.2, 1e-12);
  EXPECT_NEAR(wheels(odometer, -3.0).speed, 9.7, 1e-12) << "wheels that brake turn too slowly";
  EXPECT_NEAR(wheels(odometer, -500.0).speed, 5.0, 1e-12) << "a wheel that locks is let go";
}

TEST(WheelOdometer, SlipsTenfoldOnItsShareOfIce) {
  const WheelOdometer odometer({.white_speed = 0.0, .slip = 0.002, .ice_share = 0.2});
  double icy = 0.0;
  constexpr int squares = 4000;
  for (int square = 0; square < squares; ++square) {
    const double speed = wheels(odometer, 2.0, 50.0 * square).speed;
    EXPECT_TRUE(std::fabs(speed - 10.04) < 1e-9 || std::fabs(speed - 10.4) < 1e-9) << speed;
    if (speed > 10.2) icy += 1.0 / squares;
    // The ice is at the same places again.
    EXPECT_EQ(speed, wheels(odometer, 2.0, 50.0 * square).speed);
  }
  EXPECT_NEAR(icy, 0.2, 0.03);
  EXPECT_THROW(WheelOdometer({.slip = 1.0}), std::invalid_argument);
  EXPECT_THROW(WheelOdometer({.ice_share = -0.1}), std::invalid_argument);
}

TEST(WheelOdometer, DrawsItsErrorsFromTheirRanges) {
  double scale = 0.0, slip = 0.0, ice = 0.0;
  constexpr int seeds = 1000;
  for (int seed = 0; seed < seeds; ++seed) {
    const auto p = errors_of(WheelOdometerParameters{.errors = ErrorModel::drawn, .seed = seed});
    EXPECT_LE(std::fabs(p.scale_error), 0.02);
    EXPECT_GE(p.slip, 0.002);
    EXPECT_LE(p.slip, 0.01);
    scale += p.scale_error / seeds;
    slip += p.slip / seeds;
    ice += p.ice_share / seeds;
  }
  EXPECT_NEAR(scale, 0.0, 0.002);
  EXPECT_NEAR(slip, 0.006, 0.0005);
  EXPECT_NEAR(ice, 0.1, 0.01);
  const WheelOdometer drawn({.white_speed = 0.0, .errors = ErrorModel::drawn, .seed = 3});
  const WheelOdometer again({.white_speed = 0.0, .errors = ErrorModel::drawn, .seed = 3});
  EXPECT_NE(wheels(drawn, 0.0).speed, 10.0);
  EXPECT_EQ(wheels(drawn, 1.0).speed, wheels(again, 1.0).speed);
}

TEST(ImuNoise, DrawnSizesAreHalfToTwiceTheGivenOnes) {
  double time = 0.0;
  constexpr int seeds = 500;
  for (int seed = 0; seed < seeds; ++seed) {
    const ImuNoiseParameters given = mems_noise(seed), p = drawn(given);
    for (const auto size :
         {&ImuNoiseParameters::gyro_turn_on, &ImuNoiseParameters::gyro_instability,
          &ImuNoiseParameters::gyro_white, &ImuNoiseParameters::gyro_scale,
          &ImuNoiseParameters::accelerometer_turn_on}) {
      EXPECT_GE(p.*size, 0.5 * given.*size);
      EXPECT_LE(p.*size, 2.0 * given.*size);
    }
    EXPECT_EQ(drawn(given).gyro_white, p.gyro_white);
    time += std::log(p.instability_time) / seeds;
  }
  EXPECT_NEAR(time, 0.5 * (std::log(50.0) + std::log(1000.0)), 0.15);
}

TEST(ImuNoise, OfAMemsUnitIsOfItsGradeAndTheSameForASeed) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const OdometrySequence four(sequence("04"), {});
  const auto exact = read_all(four.imu());
  double squares = 0.0;
  constexpr int seeds = 200;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto noisy = read_all(with_noise(four.imu(), mems_noise(seed)));
    double mean = 0.0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      mean += (noisy[i].yaw_rate - exact[i].yaw_rate) / static_cast<double>(exact.size());
    }
    squares += mean * mean / seeds;
  }
  const double deg_per_hour = std::sqrt(squares) * 180.0 / M_PI * 3600.0;
  EXPECT_NEAR(deg_per_hour, 300.0, 50.0);
  const auto once = read_all(with_noise(four.imu(), mems_noise(7)));
  const auto again = read_all(with_noise(four.imu(), mems_noise(7)));
  for (std::size_t i = 0; i < once.size(); ++i) ASSERT_EQ(once[i].yaw_rate, again[i].yaw_rate);
}

TEST(NumberTable, NamesFileLineAndWhatIsWrong) {
  const auto write = [](const std::string& text) {
    const fs::path file = fs::path(::testing::TempDir()) / "table.csv";
    std::ofstream(file) << text;
    return file;
  };
  const auto refusal = [&](const std::string& text) {
    return error_of([&] { NumberTable table(write(text)); });
  };
  const NumberTable good(write("a,b\n1,2\r\n3,-4e-1\n"));
  EXPECT_EQ(good.size(), 2u);
  EXPECT_EQ(good.row(1)[good.column("b")], -0.4);
  EXPECT_THROW(good.column("c"), std::runtime_error);
  EXPECT_THAT(refusal("a,b\n1,2\n3\n"), HasSubstr(":3: has 1 columns"));
  EXPECT_THAT(refusal("a,b\n1,x\n"), HasSubstr(":2: "));
  EXPECT_THAT(refusal(""), HasSubstr("no heading"));
}

TEST(NumberTable, ReportsDamagedGzipData) {
  const fs::path file = fs::path(::testing::TempDir()) / "cut.csv.gz";
  const gzFile out = gzopen(file.c_str(), "wb");
  const std::string text = "a,b\n" + std::string(1000, '1') + ",2\n";
  gzwrite(out, text.data(), static_cast<unsigned>(text.size()));
  gzclose(out);
  fs::resize_file(file, fs::file_size(file) - 6);
  EXPECT_THAT(error_of([&] { NumberTable table(file); }), HasSubstr("damaged or cut"));
}

}  // namespace
}  // namespace maploop::sensors
