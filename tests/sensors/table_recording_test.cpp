// These tests replay drives that are tables of fixes and inertial samples.
#include "sensors/folder/table_recording.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>

#include "msgs/frames.h"
#include "msgs/input_file.h"
#include "sensors/folder/number_table.h"
#include "sensors/replay/sequence_files.h"
#include "tests/sensors/small_drive.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::sensors {
namespace {

namespace fs = std::filesystem;
using maploop::testing::error_of;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* gnss_heading =
    "t_s,lat_deg,lon_deg,height_m,vn_mps,ve_mps,vd_mps,pos_std_n_m,pos_std_e_m,pos_std_d_m,"
    "vel_std_n_mps,vel_std_e_mps,vel_std_d_mps,heading_rad\n";
constexpr const char* imu_heading = "t_s,gx_radps,gy_radps,gz_radps,ax_mps2,ay_mps2,az_mps2\n";
constexpr const char* position_heading =
    "t_s,lat_deg,lon_deg,height_m,vn_mps,ve_mps,vd_mps,heading_rad\n";
constexpr const char* attitude_heading = "t_s,roll_deg,pitch_deg,yaw_deg\n";

class Tables : public ::testing::Test {
 protected:
  Tables() {
    write("gnss.csv", std::string(gnss_heading) +
                          "-0.5,43.5,-79.7,100,1,2,-3,0.4,0.5,0.6,0.1,0.2,0.3,0\n"
                          "0.0,43.5,-79.7,100,1,2,-3,0.4,0.5,0.6,0.1,0.2,0.3,0\n");
    write("imu.csv", std::string(imu_heading) +
                         "0.00,0.1,0.2,0.3,1,2,9.8\n"
                         "0.01,0.1,0.2,0.3,1,2,9.9\n");
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }
  TableRecording opened() const { return TableRecording(folder_.path()); }
  std::string refusal() const {
    return error_of([&] { opened(); });
  }
  std::unique_ptr<AlignedImu> imu(const MountParameters& mount) const {
    const TableRecording tables = opened();
    return tables.imu(tables.gnss(), mount, 0.0);
  }

  maploop::testing::TemporaryFolder folder_;
};

TEST_F(Tables, AFixIsWhatItsRowSays) {
  const TableRecording tables = opened();
  const auto fixes = read_all(tables.gnss());
  ASSERT_EQ(fixes.size(), 2u);
  const GnssFix& fix = fixes[0];
  EXPECT_EQ(fix.stamp, parse_time("2000-01-01 00:00:00") - from_seconds(0.5));
  EXPECT_EQ(fix.velocity_stamp, fix.stamp);
  EXPECT_EQ(fix.available, fix.stamp);
  EXPECT_DOUBLE_EQ(degrees(fix.position.latitude), 43.5);
  EXPECT_DOUBLE_EQ(degrees(fix.position.longitude), -79.7);
  EXPECT_EQ(fix.velocity_enu, Eigen::Vector3d(2.0, 1.0, 3.0));
  EXPECT_NEAR(fix.position_covariance(0, 0), 0.25, 1e-12);  // east
  EXPECT_NEAR(fix.position_covariance(1, 1), 0.16, 1e-12);
  EXPECT_NEAR(fix.velocity_covariance(2, 2), 0.09, 1e-12);
  EXPECT_EQ(tables.first_stamp(), fixes[0].stamp);
  EXPECT_EQ(tables.last_stamp(), fixes[1].stamp);
  EXPECT_FALSE(tables.has_reference());
}

TEST_F(Tables, ASigmaOfZeroIsNotKnown) {
  write("gnss.csv", std::string(gnss_heading) +
                        "0.0,43.5,-79.7,100,1,2,-3,0,0,0,0,0,0,0\n"
                        "0.5,43.5,-79.7,100,1,2,-3,0,0.5,0,0.1,0,0,0\n");
  const auto fixes = read_all(opened().gnss());
  const GnssTable defaults;
  EXPECT_NEAR(fixes[0].position_covariance(0, 0),
              defaults.default_position_sigma * defaults.default_position_sigma, 1e-12);
  EXPECT_NEAR(fixes[0].velocity_covariance(0, 0),
              defaults.default_velocity_sigma * defaults.default_velocity_sigma, 1e-12);
  EXPECT_NEAR(fixes[1].position_covariance(0, 0), 0.25, 1e-12);
  EXPECT_EQ(fixes[1].position_covariance(1, 1), fixes[0].position_covariance(1, 1));
  EXPECT_EQ(fixes[1].position_covariance(2, 2), fixes[0].position_covariance(2, 2));
}

TEST_F(Tables, AUnitThatFeelsNoGravityOrTurnsTooFastIsAskedForItsUnits) {
  const auto rows = [](double rate, double force) {
    std::string text = imu_heading;
    for (int i = 0; i < 300; ++i) {
      text += fmt::format("{:.2f},0,0,{},0.1,0.2,{}\n", 0.01 * i, i % 2 == 0 ? rate : 0.0, force);
    }
    return text;
  };
  write("imu.csv", rows(0.2, 9.8));
  EXPECT_EQ(refusal(), "");
  write("imu.csv", rows(0.2, 1.0));
  EXPECT_THAT(refusal(), AllOf(HasSubstr("imu.csv"), HasSubstr("1.02 m/s^2 is the specific force"),
                               HasSubstr("accelerometer_unit")));
  write("imu.csv", rows(0.2, 980.0 / 9.8));
  EXPECT_THAT(refusal(), HasSubstr("accelerometer_unit"));
  write("imu.csv", rows(20.0, 9.8));
  EXPECT_THAT(refusal(), AllOf(HasSubstr("20 rad/s"), HasSubstr("gyro_unit")));
}

TEST_F(Tables, TimesOfTodayCountFrom1970AndColumnsMayHaveAnyOrder) {
  write("imu.csv",
        "az_mps2,t_s,gx_radps,gy_radps,gz_radps,ax_mps2,ay_mps2\n9.8,1600000000,0,0,0.25,1,2\n");
  write("gnss.csv",
        std::string(gnss_heading) + "1600000000,43.5,-79.7,100,1,2,-3,0.4,0.5,0.6,0.1,0.2,0.3,0\n");
  const auto samples = read_all(std::unique_ptr<Source<ImuSample>>(imu({true})));
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(samples[0].stamp, parse_time("2020-09-13 12:26:40"));
  EXPECT_EQ(samples[0].yaw_rate, 0.25);
  EXPECT_EQ(samples[0].specific_force_left, 2.0);
}

TEST_F(Tables, AGivenMountTurnsTheSamplesAndAnUnknownOneKeepsThemBack) {
  const auto along = read_all(std::unique_ptr<Source<ImuSample>>(imu({true, 0.0, 0.0, 90.0})));
  ASSERT_EQ(along.size(), 2u);
  EXPECT_NEAR(along[0].specific_force_forward, -2.0, 1e-12);  // the unit's x points to the left
  EXPECT_NEAR(along[0].specific_force_left, 1.0, 1e-12);
  EXPECT_TRUE(along[0].six_axes);
  const auto unknown = imu({});
  ImuSample sample;
  EXPECT_FALSE(unknown->next(sample));
  EXPECT_EQ(unknown->report().delivered, 0u);
  EXPECT_EQ(unknown->report().refused, 2u);
  ASSERT_EQ(unknown->report().refusals.size(), 1u);
  EXPECT_EQ(unknown->report().refusals[0].reason, AlignedImu::not_yet_known);
}

TEST_F(Tables, AWrongRowIsLeftOutAndReportedWithItsLine) {
  write("imu.csv", std::string(imu_heading) +
                       "0.00,0,0,0,1,2,9.8\n"
                       "0.01,99,0,0,1,2,9.8\n"
                       "0.005,0,0,0,1,2,9.8\n"
                       "9e9,0,0,0,1,2,9.8\n"
                       "0.02,0,0,0,1,2,9.8\n");
  const auto source = imu({true});
  ImuSample sample;
  while (source->next(sample)) {
  }
  const SourceReport& report = source->report();
  EXPECT_EQ(report.delivered, 3u);
  ASSERT_EQ(report.refused, 2u);
  EXPECT_EQ(report.refusals[0].line, 3u);
  EXPECT_THAT(report.refusals[0].reason, HasSubstr("gx_radps is out of range"));
  EXPECT_EQ(report.refusals[1].line, 5u);
}

TEST_F(Tables, APackedTableIsReadAndAPlainOneBefore) {
  write("gnss.csv.gz",
        gzip(std::string(gnss_heading) + "5,43.5,-79.7,100,1,2,-3,0.4,0.5,0.6,0.1,0.2,0.3,0\n"));
  EXPECT_EQ(opened().fix_count(), 2u);
  fs::remove(folder_.path() / "gnss.csv");
  EXPECT_EQ(opened().fix_count(), 1u);
}

TEST_F(Tables, WhatIsMissingOrBrokenIsNamed) {
  struct Case {
    const char *file, *text, *says;
  };
  for (const Case& c : std::initializer_list<Case>{
           {"gnss.csv", "", "gnss.csv:1: has no heading"},
           {"gnss.csv", gnss_heading, "gnss.csv: has no row that can be used: it is empty"},
           {"gnss.csv", "t_s,lat_deg\n0,43\n", "gnss.csv: has no column 'lon_deg'"},
           {"imu.csv", "t_s,gx_radps,gy_radps,gz_radps,ax_mps2,ay_mps2,az_mps2\n0,0,0,0,0,x,0\n",
            "imu.csv:2: column 6 is not a finite number"},
           {"imu.csv", "t_s,gx_radps,gy_radps,gz_radps,ax_mps2,ay_mps2,az_mps2\n0,0,0,0\n",
            "imu.csv:2: has 4 columns instead of 7"},
           {"imu.csv", "t_s,gx_radps,gy_radps,gz_radps,ax_mps2,ay_mps2,az_mps2\n0,0,0,0,0,0,999\n",
            "has no row that can be used: az_mps2 is out of range"}}) {
    const std::string before = maploop::read_text(folder_.path() / c.file, 1 << 20);
    write(c.file, c.text);
    EXPECT_THAT(refusal(), HasSubstr(c.says));
    write(c.file, before);
  }
  fs::remove(folder_.path() / "gnss.csv");
  EXPECT_TRUE(TableRecording::is_named(folder_.path()));
  EXPECT_THAT(refusal(), AllOf(HasSubstr(folder_.path()), HasSubstr("no gnss.csv")));
  fs::remove(folder_.path() / "imu.csv");
  EXPECT_FALSE(TableRecording::is_named(folder_.path()));
}

TEST_F(Tables, TheReferenceIsJoinedAndItsWildAndUnalignedRowsAreLeftOut) {
  write("reference_position.csv", std::string(position_heading) +
                                      "0,43.5,-79.7,100,1,2,-3,0\n"
                                      "1,43.5,-79.7,100,1,2,-3,0\n"
                                      "2,43.6,-79.7,100,1,2,-3,0\n"
                                      "2.5,43.6,-79.7,100,1,2,-3,0\n"
                                      "3,43.5,-79.7,100,1,2,-3,0\n"
                                      "4,43.5,-79.7,100,1,2,-3,0\n");
  write("reference_attitude.csv", std::string(attitude_heading) +
                                      "0,0,0.1,0\n"
                                      "1.01,1,2,270\n"
                                      "2,1,2,270\n"
                                      "2.5,1,2,270\n"
                                      "3,1,2,270\n"
                                      "4.1,1,2,270\n");
  const TableRecording tables = opened();
  ASSERT_TRUE(tables.has_reference());
  const auto source = tables.reference();
  const auto poses = read_all(source);
  ASSERT_EQ(poses.size(), 2u);  // at 1 and 3 s
  EXPECT_NEAR(degrees(poses[0].attitude.azimuth), -90.0, 1e-9);
  EXPECT_NEAR(degrees(poses[0].attitude.pitch), 2.0, 1e-9);
  EXPECT_NEAR(degrees(poses[0].attitude.roll), 1.0, 1e-9);
  EXPECT_EQ(source->report().refused, 4u);
}

TEST_F(Tables, AReceiverThatNeverAlignedIsNoReference) {
  write("reference_position.csv", std::string(position_heading) + "0,43.5,-79.7,100,1,2,-3,0\n");
  write("reference_attitude.csv", std::string(attitude_heading) + "0,0,0,0\n");
  EXPECT_FALSE(opened().has_reference());
}

double degrees_apart(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {  // deg
  return degrees(Eigen::AngleAxisd(a * b.transpose()).angle());
}

// The receiver's estimate is a peer. Its level differs by the accelerometers' biases (0.3 m/s^2 are
// 1.7 deg), which the apparent level of the alignment contains.
TEST(OakvilleDrives, TheMountAgreesWithTheReceivers) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const fs::path cars = maploop::testing::real_data() / "cars/oakville";
  if (!fs::exists(cars)) GTEST_SKIP() << "SKIPPED, NOT TESTED: there is no " << cars;
  const std::string never_aligned = "urban-low-speed-low-signal-001";  // by the receiver
  std::map<std::string, Eigen::Matrix3d> found;
  for (const auto& entry : fs::directory_iterator(cars)) {
    if (!TableRecording::is_named(entry.path())) continue;
    SCOPED_TRACE(entry.path());
    const TableRecording tables(entry.path());
    const auto imu = tables.imu(tables.gnss(), {}, TableRecording::cabin_ahead);
    ImuSample sample;
    while (imu->next(sample)) {
    }
    const Mount& mount = imu->alignment().mount();
    EXPECT_EQ(mount.status, MountStatus::found);
    EXPECT_GT(imu->report().delivered, 2000u);
    const std::string name = entry.path().filename();
    found[name] = mount.R_body_unit;
    if (name == never_aligned) continue;
    const NumberTable peers(*existing_table(entry.path() / "reference_mount.csv"));
    const auto row = peers.row(peers.size() - 1);
    const auto radians_of = [&](const char* name) { return radians(row[peers.column(name)]); };
    const Eigen::Matrix3d peer =
        (Eigen::AngleAxisd(radians_of("yaw_deg"), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(radians_of("pitch_deg"), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(radians_of("roll_deg"), Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    EXPECT_LT(degrees_apart(mount.R_body_unit, peer), 5.0);
  }
  ASSERT_EQ(found.size(), 10u);
  // The unit was mounted in the same way on this drive.
  EXPECT_LT(degrees_apart(found[never_aligned], found["mixed-road-highway-low-signal-001"]), 1.0);
}

}  // namespace
}  // namespace maploop::sensors
