#include "runtime/vehicle/health/meter.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace maploop::vehicle {
namespace {

using std::chrono::milliseconds;

Timing timing(int ms) {
  return {from_nanoseconds(ms),
          milliseconds(ms),
          {{{"woken late", milliseconds(1)}, {"running", milliseconds(ms - 1)}, {}}}};
}

TEST(Meter, InTimeIsNoMiss) {
  Meter meter("fusion", milliseconds(10));
  meter.record(timing(9));
  meter.record(timing(10));
  const LatencySummary s = meter.summary();
  EXPECT_EQ(s.count, 2u);
  EXPECT_EQ(s.misses, 0u);
  EXPECT_TRUE(s.worst.empty());
  EXPECT_EQ(s.guilty, "");
}

TEST(Meter, KeepsTheTenWorstMissesTheLongestFirst) {
  Meter meter("fusion", milliseconds(10));
  for (const int ms : {30, 11, 25, 12, 40, 13, 14, 15, 16, 17, 18, 19, 5, 35}) {
    meter.record(timing(ms));
  }
  const LatencySummary s = meter.summary();
  EXPECT_EQ(s.misses, 13u);
  std::vector<int> worst;
  for (const MissedDeadline& miss : s.worst) {
    worst.push_back(static_cast<int>(miss.latency / milliseconds(1)));
    EXPECT_EQ(to_nanoseconds(miss.stamp), worst.back()) << "each with its own stamp";
  }
  EXPECT_EQ(worst, (std::vector<int>{40, 35, 30, 25, 19, 18, 17, 16, 15, 14}));
  ASSERT_EQ(s.worst[0].parts.size(), 2u) << "a part without a name is none";
  EXPECT_EQ(s.worst[0].parts[1].lasted, milliseconds(39));
  EXPECT_EQ(s.guilty, "running");
  EXPECT_EQ(meter.summary().worst.size(), 10u) << "asked again without another miss";
}

TEST(Meter, IsReadWhileItRecords) {
  Meter meter("fusion", milliseconds(10));
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (int i = 0; i < 20000; ++i) meter.record(timing(11 + i % 500));
    done = true;
  });
  while (!done) {
    Duration last = Duration::max();
    for (const MissedDeadline& miss : meter.summary().worst) {
      EXPECT_LE(miss.latency, last);
      last = miss.latency;
      ASSERT_EQ(miss.parts.size(), 2u);
      EXPECT_EQ(miss.parts[0].lasted + miss.parts[1].lasted, miss.latency) << "none half written";
    }
  }
  writer.join();
  EXPECT_EQ(meter.summary().misses, 20000u);
  EXPECT_EQ(meter.summary().worst.back().latency, milliseconds(510));
}

}  // namespace
}  // namespace maploop::vehicle
