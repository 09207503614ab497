// The filter starts where the vehicle was left, and forgets this when a measurement contradicts it.
#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "estimators/fusion/guarded_filter.h"
#include "tests/estimators/fusion/left_vehicle.h"

namespace maploop::fusion::warm_start_test {
namespace {

using namespace maploop::testing;
using namespace maploop::testing::left_vehicle;
using std::chrono::hours;

LastPlace moved(LastPlace place, const Eigen::Vector3d& by, double turned = 0.0) {
  place.position = LocalFrame(place.position).to_geodetic(by);
  place.attitude.azimuth = wrap_angle(place.attitude.azimuth + turned);
  return place;
}

ReducedImuFilter started(const LastPlace& place, const std::vector<Measurement>& measurements) {
  ReducedImuFilter filter(configured("GNSS+RISS"));
  filter.recall(place);
  for (const Measurement& m : measurements) add(filter, m);
  return filter;
}

double error(const NavState& nav, const SyntheticDrive& drive, double t) {
  const Geodetic place = LocalFrame(nav.origin).to_geodetic(nav.position_enu);
  return (LocalFrame(test_origin()).to_enu(place) - drive.pose(t).translation()).norm();
}

double horizontal_sigma(const NavState& nav) {
  return std::sqrt(nav.covariance.topLeftCorner<2, 2>().trace());
}

TEST(WarmStart, GivesAPositionWithAzimuthAtTheFirstSample) {
  const SyntheticDrive drive = standing();
  const std::vector<Measurement> all = measured(drive, 2.0, 9.5, false);
  LastPlace place = place_at(drive, 0.0);
  place.stamp -= hours(8);
  ReducedImuFilter filter(configured("GNSS+RISS"));
  filter.recall(place);
  EXPECT_FALSE(filter.state_at(drive.at(2.0)));
  EXPECT_FALSE(add(filter, all.front()).refused());
  const auto first = filter.state_at(stamp_of(all.front()));
  ASSERT_TRUE(first);
  EXPECT_LT(error(*first, drive, 2.0), 1e-3);
  EXPECT_NEAR(first->attitude.azimuth, -1.2, 1e-9);
  for (const Measurement& m : all) add(filter, m);
  const NavState later = *filter.state_at(drive.at(9.4));
  EXPECT_LT(error(later, drive, 9.4), 0.05) << "without fixes, as in a garage, it lasts";
  EXPECT_LT(horizontal_sigma(later), 2.5);
  EXPECT_EQ(filter.place(), PlaceUse::started);
}

TEST(WarmStart, CarriesAVehicleThatDroveOverTheGap) {
  const SyntheticDrive drive = driving();
  const std::vector<Measurement> all = measured(drive, 7.005, 7.5, false);
  const ReducedImuFilter filter = started(place_at(drive, 5.0), {all.front()});
  const NavState first = *filter.state_at(stamp_of(all.front()));
  EXPECT_GT(horizontal_sigma(first), 3.0);
  EXPECT_LT(error(first, drive, 7.01), 2.0 * horizontal_sigma(first));
  EXPECT_GT(std::sqrt(first.covariance(6, 6)), 0.3) << "it may have turned";
}

TEST(WarmStart, ATurnInTheGapIsSeenByTheFirstFixOfTheMovingVehicle) {
  MotionProfile turns;
  turns.yaw_rate = [](double t) { return t > 5.0 && t < 8.0 ? 0.35 : 0.0; };
  const SyntheticDrive drive(turns, 20.0, test_origin());
  const LastPlace place = place_at(drive, 5.0);
  const ReducedImuFilter before = started(place, measured(drive, 8.2, 8.9));
  const ReducedImuFilter after = started(place, measured(drive, 8.2, 9.1));
  ASSERT_EQ(after.place(), PlaceUse::confirmed);
  const Time t = drive.at(9.0);
  const FusedState was = *before.state_at(t), is = *after.state_at(t);
  EXPECT_GT(std::abs(was.attitude.azimuth - drive.azimuth(9.0)), 1.0) << "60 degrees";
  EXPECT_NEAR(is.attitude.azimuth, drive.azimuth(9.0), 3.0 * std::sqrt(is.covariance(6, 6)));
  EXPECT_NEAR(is.attitude.azimuth, drive.azimuth(9.0), radians(3.0));
  EXPECT_LT((is.odom.position - was.odom.position).norm(), 0.1) << "odometry goes on";
  EXPECT_LT(error(is, drive, 9.0), 3.0);
}

TEST(WarmStart, FixesThatAgreeKeepItAndConfirmIt) {
  for (const SyntheticDrive& drive : {standing(), driving()}) {
    const bool stands = drive.speed(0.0) == 0.0;
    const LastPlace place = moved(place_at(drive, 1.0), {1.0, -1.0, 1.0}, radians(1.0));
    const ReducedImuFilter first = started(place, measured(drive, 3.0, 4.5));
    EXPECT_EQ(first.place(), stands ? PlaceUse::seen : PlaceUse::confirmed);
    const ReducedImuFilter last = started(place, measured(drive, 3.0, 18.0));
    EXPECT_EQ(last.place(), PlaceUse::confirmed);
    EXPECT_LT(error(*last.state_at(drive.at(18.0)), drive, 18.0), 1.0);
  }
}

void expect_as_cold(const ReducedImuFilter& filter, const std::vector<Measurement>& measurements,
                    Time end) {
  ReducedImuFilter cold(filter.parameters());
  for (const Measurement& m : measurements) add(cold, m);
  EXPECT_EQ(filter.initialized(), cold.initialized());
  EXPECT_EQ(filter.place(), PlaceUse::moved);
  const auto a = cold.initialized() ? filter.state_at(end) : filter.state_without_course_at(end);
  const auto b = cold.initialized() ? cold.state_at(end) : cold.state_without_course_at(end);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->position_enu, b->position_enu);
  EXPECT_EQ(a->origin, b->origin);
  EXPECT_EQ(a->attitude.azimuth, b->attitude.azimuth);
  EXPECT_EQ(a->covariance, b->covariance);
}

TEST(WarmStart, AFixElsewhereMakesTheFilterStartAsWithoutIt) {
  for (const SyntheticDrive& drive : {standing(), driving()}) {
    for (const Eigen::Vector3d& by : {Eigen::Vector3d(20.0, 0.0, 0.0), {-3e5, 2e5, 0.0}}) {
      const auto all = measured(drive, 2.5, 5.5);
      const ReducedImuFilter filter = started(moved(place_at(drive, 2.0), by), all);
      expect_as_cold(filter, all, drive.at(5.5));
    }
  }
}

TEST(WarmStart, AVehicleThatHasDrivenOffMeanwhileIsWithinItsSigmas) {
  const SyntheticDrive drive = standing();
  const ReducedImuFilter filter = started(place_at(drive, 9.0), measured(drive, 14.0, 14.1, false));
  const NavState nav = *filter.state_at(drive.at(14.1));
  EXPECT_EQ(filter.place(), PlaceUse::started);
  EXPECT_GT(error(nav, drive, 14.1), 10.0) << "it is not where it stood";
  EXPECT_LT(error(nav, drive, 14.1), 2.0 * horizontal_sigma(nav));
}

TEST(WarmStart, AVehicleThatWasTurnedIsSeenWhenItDrives) {
  const SyntheticDrive drive = standing();
  const auto all = measured(drive, 2.5, 18.5);
  const LastPlace place = moved(place_at(drive, 2.0), {0.0, 0.0, 0.0}, 3.0);
  EXPECT_EQ(started(place, measured(drive, 2.5, 9.5)).place(), PlaceUse::seen);
  const ReducedImuFilter filter = started(place, all);
  EXPECT_EQ(filter.place(), PlaceUse::moved);
  const NavState nav = *filter.state_at(drive.at(18.5));
  EXPECT_NEAR(nav.attitude.azimuth, -1.2, radians(1.0));
  EXPECT_LT(error(nav, drive, 18.5), 1.0);
}

TEST(WarmStart, TheFirstSpeedShowsThatItDoesNotStandAsItWasLeft) {
  const SyntheticDrive drive = driving();
  LastPlace place = place_at(drive, 2.0);
  place.speed = 0.0;
  const ReducedImuFilter filter = started(place, measured(drive, 2.5, 3.0, false));
  EXPECT_EQ(filter.place(), PlaceUse::moved);
  EXPECT_FALSE(filter.state_at(drive.at(3.0)));
}

TEST(WarmStart, ALaterClockJumpOrAnOldPlaceLeavesAFilterThatWaitsForAFix) {
  const SyntheticDrive drive = driving();
  LastPlace old = place_at(drive, 2.0);
  old.stamp -= hours(1);
  const auto all = measured(drive, 2.5, 3.5, false);
  EXPECT_EQ(started(old, all).place(), PlaceUse::too_old);
  EXPECT_FALSE(started(old, all).initialized());
  ReducedImuFilter filter = started(place_at(drive, 2.0), all);
  for (int i = 0; i < 200; ++i) {
    ImuSample sample;
    sample.stamp = sample.available = drive.at(1e6 + 0.01 * i);
    sample.sequence = static_cast<std::uint64_t>(i);
    filter.add(sample);
  }
  EXPECT_FALSE(filter.initialized());
  EXPECT_EQ(filter.place(), PlaceUse::none);
}

TEST(WarmStart, TheGuardsCopiesForgetItToo) {
  const SyntheticDrive drive = driving();
  GuardedFilter filter(ReducedImuFilter(configured("GNSS+RISS")));
  filter.recall(moved(place_at(drive, 2.0), {40.0, 0.0, 0.0}));
  MapFeedback feedback;
  feedback.stamp = feedback.available = drive.at(2.8);
  bool fed_back = false;
  for (const Measurement& m : measured(drive, 2.5, 12.0)) {
    if (stamp_of(m) > feedback.stamp && !fed_back) {
      filter.add(feedback);
      fed_back = true;
    }
    std::visit([&](const auto& v) { filter.add(v); }, m);
  }
  EXPECT_EQ(filter.aided().place(), PlaceUse::moved);
  feedback.stamp = feedback.available = drive.at(11.9);
  for (int i = 0; i < 3; ++i) filter.add(feedback);
  EXPECT_EQ(filter.status().restorations, 0u);
  EXPECT_LT(error(*filter.aided().state_at(drive.at(11.9)), drive, 11.9), 1.0);
}

}  // namespace
}  // namespace maploop::fusion::warm_start_test
