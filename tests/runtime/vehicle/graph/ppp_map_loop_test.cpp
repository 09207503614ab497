// Tests the loop through the road map with PPP: which data go where, and that none are used twice.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "runtime/vehicle/drivers/limited_source.h"
#include "runtime/vehicle/drivers/recording.h"
#include "runtime/vehicle/stages/road_map.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/support/real_data.h"

namespace maploop::vehicle {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Drive;
using testing::drive;
using testing::Driven;

const Recording& riverside() {
  static const Recording recording = open_recording(
      maploop::testing::real_data() / "gnss/riverside_drive/COM3_200712.obs.gz", VehicleConfig{});
  return recording;
}

std::shared_ptr<const RoadMap> roads() {
  static const auto map = [] {
    MapParameters parameters;
    parameters.file =
        (maploop::testing::real_data() / "maps/riverside/riverside_from_2021_drives.osm.pbf")
            .string();
    return load_road_map(parameters);
  }();
  return map;
}

Drive along(Duration length, MapMode mode = MapMode::tight) {
  Drive d{.sensors = riverside().sensors(Time::min()),
          .calibration = riverside().calibration,
          .map = roads(),
          .faults_from = riverside().first_stamp};
  limit(d.sensors, riverside().first_stamp + length);
  d.config.map.mode = mode;
  return d;
}

TEST(PppInTheLoop, FixesForTheFusionHoldNothingOfTheMapThatItGetsItself) {
  MAPLOOP_REQUIRE_REAL_DATA();
  const Driven loose = drive(along(seconds(90), MapMode::loose)), tight = drive(along(seconds(90)));
  ASSERT_GT(std::count_if(tight.feedbacks.begin(), tight.feedbacks.end(),
                          [](const MapFeedback& f) { return f.position; }),
            5);
  EXPECT_NE(tight.messages.at("NAV_STATE"), loose.messages.at("NAV_STATE")) << "fusion is aided";
  EXPECT_NE(tight.messages.at("PPP_STATE"), loose.messages.at("PPP_STATE")) << "PPP is aided";
  EXPECT_EQ(tight.messages.at("GNSS_FIX"), loose.messages.at("GNSS_FIX"))
      << "and its fixes are those without the map, bit for bit";
  EXPECT_LT(tight.ppp.back().position_covariance.trace(),
            loose.ppp.back().position_covariance.trace());
  EXPECT_TRUE(loose.feedbacks.empty());
}

TEST(PppInTheLoop, AStageThatEndsWithAnErrorLeavesTheRestGoingOn) {
  MAPLOOP_REQUIRE_REAL_DATA();
  for (const std::string stage : {"ppp", "mapmatch"}) {
    Drive d = along(seconds(120));  // more epochs than the ring holds
    d.faults = {"broken@" + stage + ":10"};
    const Driven run = drive(std::move(d));
    for (const ThreadHealth& thread : run.report.health.threads) {
      EXPECT_EQ(thread.failure, thread.name == stage ? "ended by an injected fault" : "");
      if (thread.name == "gnss") {
        EXPECT_GT(thread.count, 118u) << "the receiver is read to the end";
      }
    }
    if (stage == "mapmatch") {  // without ppp this drive has no input for fusion
      EXPECT_GT(run.report.data_seconds, 118.0);
    }
  }
}

TEST(PppInTheLoop, ASlowStageIsStruckAtEachEpoch) {
  MAPLOOP_REQUIRE_REAL_DATA();
  Drive d = along(seconds(10), MapMode::loose);
  d.map = nullptr;
  d.faults = {"slow@ppp,by=0.001"};
  EXPECT_GE(drive(std::move(d)).faults.at(0).struck, 10u);
}

TEST(PppInTheLoop, HasTheSameBitsInRealTimeAndResumed) {
  MAPLOOP_REQUIRE_REAL_DATA();
  Drive d = along(seconds(90));
  d.cuts = {riverside().first_stamp + milliseconds(70'550)};  // with feedback
  const Driven whole = drive(std::move(d));
  ASSERT_EQ(whole.snapshots.size(), 1u);
  EXPECT_TRUE(whole.messages.contains("MAP_FEEDBACK") && whole.messages.contains("PPP_STATE"));
  Drive in_real_time = along(seconds(90));
  in_real_time.speed = 60.0;
  EXPECT_EQ(drive(std::move(in_real_time)).messages, whole.messages);
  testing::expect_resumes(whole, [](const Snapshot* from) {
    Drive rest = along(seconds(90));
    rest.from = from;
    return drive(std::move(rest));
  });
}

}  // namespace
}  // namespace maploop::vehicle
