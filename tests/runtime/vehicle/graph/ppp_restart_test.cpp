// Tests what a run takes from the filter of PPP of the run before it.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "runtime/vehicle/drivers/limited_source.h"
#include "runtime/vehicle/drivers/recording.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;
using testing::Drive;
using testing::drive;
using testing::Driven;

// A station with an epoch every 30 s.
const Recording& station() {
  static const Recording recording =
      open_recording(maploop::testing::real_data() / "gnss/esbc_static" /
                         "ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz",
                     VehicleConfig{});
  return recording;
}

Drive between(Duration begin, Duration end) {
  Drive d{.sensors = station().sensors(Time::min()), .calibration = station().calibration};
  limit(d.sensors, station().first_stamp + end);
  d.sensors.epochs = sensors::derived(
      std::move(d.sensors.epochs),
      [from = station().first_stamp + begin](sensors::Source<GnssEpoch>& all, GnssEpoch& epoch) {
        do {
          if (!all.next(epoch)) return false;
        } while (epoch.stamp < from);
        return true;
      });
  return d;
}

// The filter after 20 minutes, when it has converged.
const Bytes& earlier() {
  static const Driven run = [] {
    Drive d = between(Duration(0), minutes(20));
    d.cuts = {station().first_stamp + minutes(19)};
    return drive(std::move(d));
  }();
  return *run.snapshots.at(0).part("ppp");
}

Driven restarted(Duration begin) {
  Drive d = between(begin, begin + minutes(2));
  d.ppp = &earlier();
  return drive(std::move(d));
}

constexpr const char* of_another_time = "state of the last run: of another time";

double sigma(const PppState& state) {
  return std::sqrt(state.position_covariance.trace());
}

TEST(PppRestart, ItIsAsSureAsBeforeAtTheFirstEpoch) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Driven warm = restarted(minutes(22)), cold = drive(between(minutes(22), minutes(24)));
  EXPECT_LT(sigma(warm.ppp.at(0)), 0.15);
  EXPECT_GT(sigma(cold.ppp.at(0)), 1.0);
  EXPECT_NE(warm.ppp.at(0).status, PppStatus::converging);
  EXPECT_EQ(warm.refused("ppp", of_another_time), 0U);
}

TEST(PppRestart, AFilterOfLongAgoOrOfLaterIsForgotten) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const Duration begin : {minutes(30), minutes(10)}) {
    const Driven late = restarted(begin), cold = drive(between(begin, begin + minutes(2)));
    EXPECT_EQ(late.refused("ppp", of_another_time), 1U);
    EXPECT_EQ(late.messages.at("PPP_STATE"), cold.messages.at("PPP_STATE"));
  }
}

TEST(PppRestart, SnapshotsBetweenTwoEpochsHoldUpNothing) {
  MAPLOOP_REQUIRE_REAL_DATA();
  Drive d = between(Duration(0), seconds(95));
  for (int i = 1; i < 18; ++i) d.cuts.push_back(station().first_stamp + seconds(5 * i));
  const Driven run = drive(std::move(d));
  EXPECT_EQ(run.snapshots.size(), 17U);
  EXPECT_EQ(run.ppp.size(), 4U);
}

}  // namespace
}  // namespace maploop::vehicle
