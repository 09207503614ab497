// The filter starts where the vehicle was left, and forgets this when a measurement contradicts it.
#include "estimators/fusion/last_place.h"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "estimators/fusion/guarded_filter.h"
#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

// Returns the vehicle's true place at `t`, as well known as a filter with fixes knows it.
LastPlace place_at(const SyntheticDrive& drive, double t) {
  LastPlace place;
  place.stamp = SyntheticDrive::at(t);
  place.position = LocalFrame(test_origin()).to_geodetic(drive.pose(t).translation());
  place.attitude = {drive.azimuth(t), drive.pitch(t), drive.roll(t)};
  place.speed = drive.speed(t);
  place.position_sigma = {1.0, 1.0, 2.0};
  place.azimuth_sigma = radians(0.5);
  place.tilt_sigma = radians(0.5);
  place.speed_sigma = 0.1;
  return place;
}

LastPlace moved(LastPlace place, const Eigen::Vector3d& by, double turned = 0.0) {
  place.position = LocalFrame(place.position).to_geodetic(by);
  place.attitude.azimuth = wrap_angle(place.attitude.azimuth + turned);
  return place;
}

// Stands for 10 s, and drives off.
SyntheticDrive standing() {
  MotionProfile profile;
  profile.speed = [](double t) { return t < 10.0 ? 0.0 : 1.5 * (t - 10.0); };
  profile.azimuth = -1.2;
  return {profile, 20.0, test_origin()};
}

SyntheticDrive driving() {
  MotionProfile profile;
  profile.yaw_rate = [](double t) { return 0.1 * std::sin(t); };
  profile.azimuth = 0.7;
  return {profile, 20.0, test_origin()};
}

std::vector<Measurement> measured(const SyntheticDrive& drive, double from, double to,
                                  bool fixes = true) {
  std::vector<Measurement> all, part;
  append(all, drive.imu(100.0));
  append(all, drive.wheels(0.0, 20.0));
  for (int i = 0; fixes && i < 20; ++i) {
    all.push_back(drive.fix(i));
    std::get<GnssFix>(all.back()).sequence = static_cast<std::uint64_t>(i);
  }
  for (const Measurement& m : all) {
    const Time t = stamp_of(m);
    if (t >= SyntheticDrive::at(from) && t < SyntheticDrive::at(to)) part.push_back(m);
  }
  sort_as_available(part);
  return part;
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

TEST(LastPlace, OfAVehicleThatStoodHoldsAndIsLessCertainTheLongerItIsAway) {
  const LastPlace place = place_at(standing(), 5.0);
  const auto after = [&](Duration age) { return start_at(place, place.stamp + age, {}); };
  const PlaceStart soon = after(seconds(3)), month = after(hours(24 * 30));
  ASSERT_EQ(soon.use, PlaceUse::started);
  EXPECT_EQ(soon.start.stamp, place.stamp + seconds(3));
  EXPECT_EQ(soon.start.position, place.position);
  EXPECT_NEAR(soon.start.position_sigma.x(), std::hypot(1.0, 0.5, 4.5), 0.01) << "it may drive";
  EXPECT_NEAR(soon.start.position_sigma.z(), std::hypot(2.0, 0.5, 0.225), 0.01);
  const PlaceStart later = after(std::chrono::minutes(2));
  EXPECT_NEAR(later.start.position_sigma.x(), std::hypot(1.0, 0.5), 0.05) << "it was left";
  ASSERT_EQ(month.use, PlaceUse::started);
  EXPECT_GT(month.start.position_sigma.y(), 3.0);
  EXPECT_LT(month.start.position_sigma.y(), 4.0);
  EXPECT_EQ(after(hours(24 * 366)).use, PlaceUse::too_old);
}

TEST(LastPlace, OfAVehicleThatDroveHoldsForSecondsAndKeepsItsStamp) {
  const LastPlace place = place_at(driving(), 5.0);
  const auto after = [&](Duration age) { return start_at(place, place.stamp + age, {}); };
  EXPECT_EQ(after(seconds(4)).use, PlaceUse::started);
  EXPECT_EQ(after(seconds(4)).start.stamp, place.stamp);
  EXPECT_EQ(after(seconds(6)).use, PlaceUse::too_old);
  EXPECT_EQ(after(-milliseconds(60)).use, PlaceUse::started) << "a sample is delivered later";
  EXPECT_EQ(after(-seconds(2)).use, PlaceUse::from_future);
  EXPECT_EQ(start_at(place, Time(seconds(1000)), {}).use, PlaceUse::from_future);
}

TEST(LastPlace, ThatIsUncertainOrImpossibleIsNotUsed) {
  const LastPlace place = place_at(standing(), 5.0);
  const auto use = [&](auto spoil) {
    LastPlace spoilt = place;
    spoil(spoilt);
    return start_at(spoilt, place.stamp, {}).use;
  };
  EXPECT_EQ(use([](LastPlace& p) { p.position_sigma.y() = 60.0; }), PlaceUse::too_uncertain);
  EXPECT_EQ(use([](LastPlace& p) { p.azimuth_sigma = 0.6; }), PlaceUse::too_uncertain);
  EXPECT_EQ(use([](LastPlace& p) { p.azimuth_sigma = NAN; }), PlaceUse::too_uncertain);
  EXPECT_EQ(use([](LastPlace& p) { p.position.latitude = 2.0; }), PlaceUse::too_uncertain);
  EXPECT_EQ(use([](LastPlace& p) { p.speed = -200.0; }), PlaceUse::too_uncertain);
}

TEST(LastPlace, IsThatOfTheState) {
  const SyntheticDrive drive = driving();
  ReducedImuFilter filter(configured("GNSS+RISS"), test_origin());
  for (const Measurement& m : measured(drive, 0.0, 8.0)) add(filter, m);
  const LastPlace place = filter.here().value();
  const NavState nav = *filter.state_at(place.stamp);
  EXPECT_LT((LocalFrame(test_origin()).to_enu(place.position) - nav.position_enu).norm(), 1e-6);
  EXPECT_EQ(place.speed, nav.forward_speed);
  EXPECT_NEAR(place.speed_sigma, 0.15, 0.15);
  EXPECT_EQ(place.azimuth_sigma, std::sqrt(nav.covariance(6, 6)));
  EXPECT_LT(place.fix_offset_correlation.x(), -0.5) << "both are known by their sum";
  // A start from it has the covariance of the state, and the correlation fades with the error.
  const PlaceStart start = start_at(place, place.stamp, {});
  ReducedImuFilter next(configured("GNSS+RISS"));
  ASSERT_FALSE(next.start(start.start).refused());
  const LastPlace again = next.here().value();
  EXPECT_NEAR((again.position_sigma - place.position_sigma).norm(), 0.0, 1e-9);
  EXPECT_NEAR((again.fix_offset - place.fix_offset).norm(), 0.0, 1e-9);
  EXPECT_NEAR((again.fix_offset_correlation - place.fix_offset_correlation).norm(), 0.0, 1e-9);
  LastPlace left = place;
  left.speed = 0.0;
  const KnownStart tomorrow = start_at(left, place.stamp + hours(24), {}).start;
  EXPECT_NEAR(tomorrow.fix_offset_sigma.x(), 1.0, 1e-9);
  EXPECT_NEAR(tomorrow.fix_offset_correlation.norm(), 0.0, 1e-9);
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
}  // namespace maploop::fusion
