#include "estimators/fusion/event_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::fusion {
namespace {

using maploop::testing::SyntheticDrive;

EventKey key(double t, EventKind kind = EventKind::imu, std::uint64_t sequence = 0) {
  return {SyntheticDrive::at(t), kind, sequence};
}

TEST(EventHistory, KeepsTheOrderOfStampKindAndSequence) {
  std::vector<EventKey> keys;
  for (double t : {1.0, 1.1, 1.2}) {
    for (const EventKind kind : {EventKind::imu, EventKind::odometry, EventKind::clone}) {
      for (std::uint64_t n = 0; n < 2; ++n) keys.push_back(key(t, kind, n));
    }
  }
  std::vector<EventKey> shuffled = keys;
  std::mt19937 random(5);
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  EventHistory history(keys.size());
  for (const EventKey& k : shuffled) {
    const std::size_t position = history.insert(k, ImuSample{});
    EXPECT_EQ(history[position].key, k);
  }
  EXPECT_TRUE(history.full());
  for (std::size_t i = 0; i < keys.size(); ++i) EXPECT_EQ(history[i].key, keys[i]) << i;
}

TEST(EventHistory, FindsAndForgets) {
  EventHistory history(2);
  history.insert(key(1.0), ImuSample{});
  history.insert(key(2.0), ImuSample{});
  EXPECT_TRUE(history.contains(key(1.0)));
  EXPECT_FALSE(history.contains(key(1.0, EventKind::odometry)));
  EXPECT_EQ(history.position_after(key(1.5)), 1u);
  history.pop_front();
  EXPECT_FALSE(history.full());
  EXPECT_FALSE(history.contains(key(1.0)));
  EXPECT_EQ(history[0].key, key(2.0));
  history.clear();
  EXPECT_EQ(history.size(), 0u);
}

}  // namespace
}  // namespace maploop::fusion
