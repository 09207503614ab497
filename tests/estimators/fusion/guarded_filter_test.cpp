// These tests cover the filter that notices when the map misleads it.
#include "estimators/fusion/guarded_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/road_feedback.h"
#include "tests/estimators/fusion/synthetic_drive.h"
#include "tests/support/broken_archives.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;

// The map of this straight drive has a road that diverges by 0.1 rad, little enough to pass the
// gates of its line.
struct Misled {
  double error = 0.0, free_error = 0.0, largest = 0.0, largest_free = 0.0;
  std::uint64_t restorations = 0;
};

Misled drive_beside_wrong_road(const GuardParameters& guard, double wrong_from) {
  const SyntheticDrive drive({}, 200.0, test_origin());
  ReducedImuFilter plain = started_filter();
  GuardedFilter filter(plain, guard);
  const LocalFrame frame(test_origin());
  Misled result;
  const auto imu = drive.imu(10.0);
  const auto wheels = drive.wheels(0.0, 200.05);
  for (std::size_t i = 1; i < imu.size(); ++i) {
    const ImuSample& s = imu[i];
    const double t = to_seconds(s.stamp - SyntheticDrive::at(0.0));
    filter.add(s);
    filter.add(wheels[i]);
    plain.add(s);
    plain.add(wheels[i]);
    if (i % 10 != 0) continue;
    const double right = t > wrong_from ? 1.0 * (t - wrong_from) : 0.0;
    MapFeedback f = road(frame, drive.pose(t).translation().head<2>(), right);
    if (t > wrong_from) f.link_azimuth = 0.1;
    f.stamp = f.available = s.stamp;
    f.sequence = i;
    filter.add(f);
    const Eigen::Vector2d truth = drive.pose(t).translation().head<2>();
    result.error = (filter.aided().state_at(s.stamp)->position_enu.head<2>() - truth).norm();
    result.free_error = (plain.state_at(s.stamp)->position_enu.head<2>() - truth).norm();
    result.largest = std::max(result.largest, result.error);
    result.largest_free = std::max(result.largest_free, result.free_error);
  }
  result.restorations = filter.status().restorations;
  return result;
}

TEST(GuardedFilter, IsNotLedAstrayByARoadThatPassesTheGates) {
  GuardParameters unguarded;
  unguarded.difference_gate = std::numeric_limits<double>::infinity();
  const Misled without = drive_beside_wrong_road(unguarded, 60.0);
  const Misled with = drive_beside_wrong_road({}, 60.0);
  EXPECT_EQ(without.restorations, 0u);
  EXPECT_GT(with.restorations, 0u);
  EXPECT_LT(with.largest, 0.6 * without.largest);
}

TEST(GuardedFilter, LeavesARightRoadAlone) {
  const Misled right = drive_beside_wrong_road({}, 1e9);
  EXPECT_EQ(right.restorations, 0u);
  EXPECT_LT(right.largest, 1.0);
}

TEST(GuardedFilter, GoesOnFromAnArchive) {
  GuardedFilter filter(started_filter(), {});
  const SyntheticDrive drive({}, 20.0, test_origin());
  const LocalFrame frame(test_origin());
  const auto add = [&](GuardedFilter& to, const ImuSample& s) {
    to.add(s);
    MapFeedback f = road(frame, {0.0, 0.0});
    f.stamp = f.available = s.stamp;
    f.sequence = s.sequence;
    to.add(f);
  };
  const auto imu = drive.imu(10.0);
  for (const ImuSample& s : imu)
    if (s.stamp > SyntheticDrive::at(0.0) && s.stamp < SyntheticDrive::at(10.0)) add(filter, s);
  GuardedFilter resumed(ReducedImuFilter(configured("RISS")), {});
  load(saved(filter), resumed);
  for (const ImuSample& s : imu) {
    if (s.stamp < SyntheticDrive::at(10.0)) continue;
    add(filter, s);
    add(resumed, s);
  }
  EXPECT_EQ(saved(filter), saved(resumed));
  EXPECT_LT(saved(filter).size(), filter.largest_archive(true));
  expect_refuses_broken(saved(filter), resumed);
}

}  // namespace
}  // namespace maploop::fusion
