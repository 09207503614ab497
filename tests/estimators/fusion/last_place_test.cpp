// Tests what the last place says at the next start, the longer ago the less.
#include "estimators/fusion/last_place.h"

#include <gtest/gtest.h>

#include <chrono>

#include "tests/estimators/fusion/left_vehicle.h"

namespace maploop::fusion::last_place_test {
namespace {

using namespace maploop::testing;
using namespace maploop::testing::left_vehicle;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

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

}  // namespace
}  // namespace maploop::fusion::last_place_test
