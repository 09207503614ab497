// Tests the three lines at the end of a run.
#include "tools/replay/replay_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "estimators/fusion/outcome.h"

namespace maploop::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

vehicle::SensorReport sensor(const char* name, std::uint64_t delivered, std::uint64_t refused = 0) {
  vehicle::SensorReport s;
  s.name = name;
  s.source.delivered = delivered;
  s.source.refused = refused;
  return s;
}

ReplayResult good() {
  ReplayResult r;
  r.configuration = "VO-L-RI";
  r.images = 144;
  r.vehicle.data_seconds = 14.9;
  r.vehicle.sensors = {sensor("camera", 144), sensor("imu", 144), sensor("gnss", 15)};
  r.end.emplace();
  r.end->origin = {radians(49.0), radians(-8.4), 100.0};
  r.end->covariance(0, 0) = r.end->covariance(1, 1) = 2.0;
  r.navigation.emplace();
  r.navigation->whole.rmse = 4.01;
  r.navigation->whole.max = 5.67;
  r.navigation->whole.covered = 1.0;
  return r;
}

RefusalCount after_start(std::uint64_t count) {
  return {"fusion", std::string(to_string(fusion::Reason::already_started)), count};
}

TEST(Verdict, SaysWhereHowGoodAndWhatWasNotUsed) {
  ReplayResult r = good();
  r.vehicle.health.refusals = {{"lidar", "first frame", 2}, after_start(14)};
  const auto lines = verdict(r);
  EXPECT_EQ(lines[0], "After 14.9 s at 49.000000 N 8.400000 W, +-2.0 m (1 sigma).");
  EXPECT_EQ(lines[1], "Horizontal error 4.01 m RMS, 5.67 m at most, against the reference.");
  EXPECT_EQ(lines[2], "VO-L-RI did not use GNSS after the start (14 fixes; GNSS+VO-L-RI uses it)");
  EXPECT_EQ(why_empty(r), std::nullopt);
}

TEST(Verdict, AnOldPositionIsNotTheOneAtTheEnd) {
  ReplayResult r = good();
  r.vehicle.last = Time(std::chrono::seconds(1000));
  r.end->stamp = r.vehicle.last - std::chrono::seconds(6);
  r.without_position = 6.0;
  const auto lines = verdict(r);
  EXPECT_EQ(lines[0],
            "After 14.9 s: no position since 8.9 s, then at 49.000000 N 8.400000 W, +-2.0 m "
            "(1 sigma).");
  EXPECT_THAT(lines[1], HasSubstr("the reference. No position for 6 s after the first."));
}

TEST(NavTrack, CountsTheTimeWithoutAPosition) {
  fusion_score::NavTrack track;
  for (const double t : {0.0, 0.1, 0.2, 5.2, 5.3}) {
    NavState state;
    state.stamp = Time(from_seconds(100.0 + t));
    state.status = NavStatus::aided;
    track.add(state);
  }
  EXPECT_NEAR(track.silent_until(Time(from_seconds(105.4))), 5.0, 1e-9);
  EXPECT_NEAR(track.silent_until(Time(from_seconds(108.3))), 8.0, 1e-9);
}

TEST(Verdict, ScoresNothingWhereNothingIsScored) {
  ReplayResult r = good();
  for (const bool peer : {false, true}) {
    r.peer_reference = peer;
    r.navigation->whole = {};
    EXPECT_THAT(verdict(r)[1], StartsWith("Not scored: "));
  }
}

TEST(Verdict, OfARunThatUsedEverythingSaysSo) {
  EXPECT_EQ(verdict(good())[2], "VO-L-RI used all that it was given.");
}

TEST(Verdict, FitsATerminalWhateverHappened) {
  ReplayResult r = good();
  r.interrupted = true;
  r.configuration = "GNSS+VO-L-RI";
  r.vehicle.data_seconds = 123456.7;
  r.end->origin = {radians(-33.971235), radians(-117.321235), 100.0};
  r.end->covariance(0, 0) = 1e10;
  r.navigation->whole.rmse = r.navigation->whole.max = 99999.99;
  r.navigation->whole.covered = 0.5;
  r.vehicle.sensors.push_back(sensor("velodyne", 100, 12345));
  r.vehicle.health.refusals = {after_start(12345),
                               {"stereo", "too few features in the image to be of any use", 99},
                               {"mapmatch", "not later than the fix before", 98}};
  for (const std::string& line : verdict(r)) EXPECT_LE(line.size(), 79u) << line;
  EXPECT_THAT(verdict(r)[0], StartsWith("Interrupted after "));
  EXPECT_THAT(verdict(r)[2], HasSubstr(" more"));
}

TEST(Verdict, OfAReceiverSaysWhereItCannotConverge) {
  ReplayResult r = good();
  r.navigation.reset();
  r.ppp.emplace();
  r.ppp->by_status[static_cast<std::size_t>(PppStatus::converging)] = 3810;
  EXPECT_THAT(verdict(r)[1], StartsWith("PPP has not converged yet"));
  r.ppp->never_converges = true;
  EXPECT_THAT(verdict(r)[1], StartsWith("PPP does not converge to 0.1 m on one frequency"));
}

TEST(Verdict, AReferenceThatIsAPeerIsCalledSoAndOutagesAreScoredAtTheFixes) {
  ReplayResult r = good();
  r.configuration = "GNSS+RI";
  r.peer_reference = true;
  r.vehicle.sensors[1] = sensor("imu", 100'000, 9'876);
  r.vehicle.sensors[1].source.refusals = {{"imu.csv", 0, "the mount was not yet known"}};
  EXPECT_EQ(verdict(r)[1], "4.01 m RMS, 5.7 m at most, from the receiver's own fusion, a peer.");
  EXPECT_EQ(verdict(r)[2], "GNSS+RI did not use 9876 of imu (the mount was not yet known)");
  for (const double error : {3.0, 12.0, 40.0}) {
    fusion_score::OutageEnd end;
    end.error = error;
    r.outage_ends.push_back(end);
  }
  EXPECT_EQ(verdict(r)[1], "After 3 made outages 12.0 m from the fixes (median), 40.0 m at worst.");
  r.outage_ends[0].error = 99'999.9;
  for (const std::string& line : verdict(r)) EXPECT_LE(line.size(), 79u) << line;
}

TEST(Verdict, ARunWithoutAPositionIsEmptyAndSaysWhy) {
  ReplayResult r = good();
  r.end.reset();
  r.navigation.reset();
  EXPECT_EQ(verdict(r)[0], "After 14.9 s: no position.");
  r.has_gnss = false;
  EXPECT_THAT(why_empty(r).value_or(""), HasSubstr("the recording has no GNSS to start from"));
  r.has_gnss = true;
  r.vehicle.health.refusals = {{"fusion", std::string(to_string(fusion::Reason::no_course)), 30}};
  EXPECT_THAT(why_empty(r).value_or(""),
              HasSubstr("most often: too slow or too uncertain for a course"));
  r.vehicle.sensors.back() = sensor("gnss", 0);
  EXPECT_THAT(why_empty(r).value_or(""), HasSubstr("no GNSS came to start from"));
  r.interrupted = true;
  EXPECT_EQ(why_empty(r), std::nullopt);
}

TEST(Verdict, AScannerAloneHasItsOdometryForAResult) {
  ReplayResult r;
  r.configuration = "VO-L-RI";
  r.images = 2;
  r.has_gnss = false;
  r.vehicle.sensors = {sensor("camera", 0), sensor("velodyne", 2), sensor("imu", 0)};
  EXPECT_EQ(why_empty(r), std::nullopt);
}

TEST(Verdict, ALiveRunIsEmptyWhereNoSensorSpoke) {
  ReplayResult r;
  r.live = true;
  r.vehicle.sensors = {sensor("camera", 0), sensor("imu", 0)};
  EXPECT_THAT(why_empty(r).value_or(""), HasSubstr("no sensor gave a single sample"));
  r.vehicle.sensors.front() = sensor("camera", 1);
  EXPECT_EQ(why_empty(r), std::nullopt);
}

TEST(Verdict, AMapOfAnotherPlaceLeavesTheRunEmpty) {
  ReplayResult r = good();
  r.map = {"47.0000 to 47.3000 N, 9.4000 to 9.7000 E", true};
  EXPECT_THAT(why_empty(r).value_or(""), HasSubstr("which covers 47.0000 to 47.3000 N"));
  r.map->elsewhere = false;
  EXPECT_EQ(why_empty(r), std::nullopt);
}

}  // namespace
}  // namespace maploop::tools
