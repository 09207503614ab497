// Tests a drive of a GNSS receiver alone through the whole graph.
#include "runtime/vehicle/drivers/gnss_drive.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "runtime/vehicle/drivers/limited_source.h"
#include "runtime/vehicle/drivers/recording.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using maploop::testing::error_of;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::AllOf;
using testing::Drive;
using testing::drive;
using testing::Driven;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

// Returns the observations of a car at 1 Hz, GPS and Galileo on two frequencies.
std::filesystem::path car() {
  return maploop::testing::real_data() / "gnss/kamakura_kinematic/SEPT265G.21O.gz";
}

const Recording& recording() {
  static const Recording recording = open_recording(car(), VehicleConfig{});
  return recording;
}

Sensors sensors(Duration length) {
  Sensors s = recording().sensors(Time::min());
  limit(s, recording().first_stamp + length);
  return s;
}

Drive with_epochs(Duration length) {
  return {.sensors = sensors(length),
          .calibration = recording().calibration,
          .faults_from = recording().first_stamp};
}

TEST(GnssDrive, EveryEpochIsSaidAndTheFusionFollows) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Driven run = drive(with_epochs(seconds(90)));
  ASSERT_EQ(run.ppp.size(), 90u);
  ASSERT_EQ(run.messages.at("GNSS_FIX").size(), 90u);
  const PppState& last = run.ppp.back();
  EXPECT_EQ(last.available - last.stamp, milliseconds(110)) << "the receiver's latency, the budget";
  EXPECT_NE(last.status, PppStatus::none);
  EXPECT_EQ(last.converging_for, 89.0);
  EXPECT_GE(last.satellites_used, 8);
  EXPECT_GT(last.satellites.size(), static_cast<std::size_t>(last.satellites_used))
      << "those refused are said too";
  EXPECT_EQ(last.integrity_risk, 1e-4);
  EXPECT_GT(last.protection.up, 3.8 * std::sqrt(last.position_covariance(2, 2)));
  EXPECT_GT(last.code_rms, 0.0);
  EXPECT_LT(last.phase_rms, 0.1);

  const NavState& state = run.states.back();
  ASSERT_NE(state.status, NavStatus::uninitialized) << "the car has moved by then";
  EXPECT_LT(state.stamp - state.gnss_stamp, seconds(2)) << "fixes are used after the start too";
  const Eigen::Vector3d p = LocalFrame(state.origin).to_enu(last.position);
  EXPECT_LT((p - state.position_enu).norm(), 3.0);
  EXPECT_THAT(run.report.health.degraded, Each(Not(HasSubstr("ppp"))));
}

TEST(GnssDrive, RealTimeHasTheBitsOfLockstepAndSoHasAResumedRun) {
  MAPLOOP_REQUIRE_REAL_DATA();
  // Between an epoch and its result.
  const std::vector<Time> cuts{recording().first_stamp + milliseconds(20'105)};
  Drive d = with_epochs(seconds(40)), in_real_time = with_epochs(seconds(40));
  d.cuts = in_real_time.cuts = cuts;
  in_real_time.speed = 20.0;
  const Driven lockstep = drive(std::move(d)), paced = drive(std::move(in_real_time));
  EXPECT_EQ(paced.messages, lockstep.messages);
  ASSERT_EQ(lockstep.snapshots.size(), 1u);
  EXPECT_TRUE(paced.snapshots.at(0).parts == lockstep.snapshots.at(0).parts);
  testing::expect_resumes(lockstep, [](const Snapshot* from) {
    Drive rest = with_epochs(seconds(40));
    rest.from = from;
    return drive(std::move(rest));
  });
}

TEST(GnssDrive, InvalidNumbersCountAsNotMeasured) {
  MAPLOOP_REQUIRE_REAL_DATA();
  Drive d = with_epochs(seconds(20));
  d.faults = {"nan@gnss:10:2"};
  const Driven run = drive(std::move(d));
  ASSERT_EQ(run.ppp.size(), 20u);
  EXPECT_EQ(run.ppp[10].status, PppStatus::none);
  EXPECT_EQ(run.ppp[10].satellites.at(0).refusal, PppRefusal::no_signals);
  EXPECT_NE(run.ppp[15].status, PppStatus::none);
  EXPECT_TRUE(run.ppp.back().position_covariance.allFinite());
}

TEST(GnssDrive, AFolderWithTwoReceiversIsRefusedByName) {
  MAPLOOP_REQUIRE_REAL_DATA();
  EXPECT_TRUE(is_gnss_drive(car()));
  EXPECT_TRUE(is_gnss_drive(car().parent_path()));
  EXPECT_FALSE(is_gnss_drive(maploop::testing::real_data()));
  EXPECT_THAT(error_of([] { open_recording(car().parent_path(), VehicleConfig{}); }),
              AllOf(HasSubstr("2 receivers; name the file"), HasSubstr("3034265G.21O.gz")));
}

TEST(GnssDrive, ProductsMayBeNamed) {
  MAPLOOP_REQUIRE_REAL_DATA();
  VehicleConfig config;
  config.ppp.products = {(car().parent_path() / "SEPT2650.21P.gz").string()};
  EXPECT_FALSE(GnssDrive(car(), config).setup().precise());
  config.ppp.products = {(maploop::testing::real_data() / "gnss/models").string()};
  EXPECT_THROW(GnssDrive(car(), config), std::runtime_error) << "no orbits among them";
}

}  // namespace
}  // namespace maploop::vehicle
