// Tests a drive of a GNSS receiver alone through the whole graph.
#include "runtime/vehicle/drivers/gnss_drive.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "runtime/vehicle/drivers/limited_source.h"
#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/faults/fault_injection.h"
#include "tests/support/message_tape.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using maploop::testing::MessageTape;
using runtime::DataClock;
using std::chrono::milliseconds;
using std::chrono::seconds;

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

struct Driven {
  MessageTape::Channels messages;
  std::vector<PppState> ppp;
  std::vector<NavState> nav;
  VehicleReport report;
  std::vector<Snapshot> snapshots;
};

Driven drive(Sensors given, const DataClock& clock, const std::vector<Time>& cuts = {},
             const Snapshot* from = nullptr) {
  Driven run;
  MessageTape tape;
  Observer observer;
  observer.ppp = [&](const PppState& s) { run.ppp.push_back(s); };
  observer.nav_state = [&](const NavState& s) { run.nav.push_back(s); };
  Vehicle vehicle({}, recording().calibration, std::move(given), clock, {&tape}, observer);
  vehicle.take_snapshots(cuts, [&](const Snapshot& s) { run.snapshots.push_back(s); });
  if (from != nullptr) vehicle.resume(*from);
  vehicle.start();
  vehicle.wait();
  run.messages = tape.all();
  run.report = vehicle.report();
  return run;
}

TEST(GnssDrive, EveryEpochIsSaidAndTheFusionFollows) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Driven run = drive(sensors(seconds(90)), DataClock::virtual_time());
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

  const NavState& state = run.nav.back();
  ASSERT_NE(state.status, NavStatus::uninitialized) << "the car has moved by then";
  EXPECT_LT(state.stamp - state.gnss_stamp, seconds(2)) << "fixes are used after the start too";
  const Eigen::Vector3d p = LocalFrame(state.origin).to_enu(last.position);
  EXPECT_LT((p - state.position_enu).norm(), 3.0);
  for (const std::string& sentence : run.report.health.degraded) {
    EXPECT_EQ(sentence.find("ppp"), std::string::npos) << sentence;
  }
}

TEST(GnssDrive, RealTimeHasTheBitsOfLockstepAndSoHasAResumedRun) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Time cut =
      recording().first_stamp + milliseconds(20'105);  // between an epoch and its result
  const Driven lockstep = drive(sensors(seconds(40)), DataClock::virtual_time(), {cut});
  const Driven paced = drive(sensors(seconds(40)), DataClock::paced(20.0), {cut});
  EXPECT_EQ(paced.messages, lockstep.messages);
  ASSERT_EQ(lockstep.snapshots.size(), 1u);
  EXPECT_TRUE(paced.snapshots.at(0).parts == lockstep.snapshots.at(0).parts);

  const Driven resumed =
      drive(sensors(seconds(40)), DataClock::virtual_time(), {}, &lockstep.snapshots[0]);
  MessageTape::Channels later;
  for (const auto& [channel, messages] : lockstep.messages) {
    for (const MessageTape::Taped& message : messages) {
      if (message.time > lockstep.snapshots[0].at) later[channel].push_back(message);
    }
  }
  EXPECT_EQ(resumed.messages, later);
}

TEST(GnssDrive, InvalidNumbersCountAsNotMeasured) {
  MAPLOOP_REQUIRE_REAL_DATA();
  FaultInjection faults({parse_fault("nan@gnss:10:2")}, recording().first_stamp);
  const Driven run = drive(faults.inject(sensors(seconds(20))), DataClock::virtual_time());
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
  try {
    open_recording(car().parent_path(), VehicleConfig{});
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("2 receivers; name the file"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("3034265G.21O.gz"), std::string::npos);
  }
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
