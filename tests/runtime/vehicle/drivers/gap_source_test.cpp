#include "runtime/vehicle/drivers/gap_source.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/runtime/vehicle/fake_sensors.h"

namespace maploop::vehicle {
namespace {

using std::chrono::hours;
using std::chrono::seconds;
using testing::drive_start;

// Returns the numbers of the delivered samples; `times` are those of all samples, after the start.
std::vector<std::uint64_t> delivered(const std::vector<Duration>& times,
                                     sensors::SourceReport* report = nullptr) {
  GapSource<ImuSample> source(testing::fake_source<ImuSample>(
      times.size(),
      [&times](std::uint64_t i, ImuSample& s) { s.available = s.stamp = drive_start + times[i]; }));
  std::vector<std::uint64_t> numbers;
  for (ImuSample sample; source.next(sample);) numbers.push_back(sample.sequence);
  if (report != nullptr) *report = source.report();
  return numbers;
}

using Numbers = std::vector<std::uint64_t>;

TEST(GapSource, LeavesARecordingAsItIs) {
  sensors::SourceReport report;
  EXPECT_EQ(delivered({seconds(0), seconds(1), hours(1)}, &report), (Numbers{0, 1, 2}));
  EXPECT_EQ(report.delivered, 3u);
  EXPECT_EQ(report.refused, 0u);
  EXPECT_EQ(delivered({}), Numbers{});
}

TEST(GapSource, LeavesOutOneStampYearsAhead) {
  sensors::SourceReport report;
  EXPECT_EQ(delivered({seconds(0), seconds(1), hours(1'000'000)}, &report), (Numbers{0, 1}));
  EXPECT_EQ(report.delivered, 2u);
  ASSERT_EQ(report.refusals.size(), 1u);
  EXPECT_EQ(report.refusals[0].file, "sample 2");
}

TEST(GapSource, LeavesOutARestYearsAhead) {
  const Duration far = hours(1'000'000);
  EXPECT_EQ(delivered({seconds(0), seconds(1), far, far + seconds(1), far + seconds(2)}),
            (Numbers{0, 1}));
}

TEST(GapSource, GoesOnBehindAPause) {
  EXPECT_EQ(delivered({seconds(0), hours(2), hours(2) + seconds(1), hours(2) + seconds(2)}),
            (Numbers{0, 1, 2, 3}));
  EXPECT_EQ(delivered({seconds(0), hours(2), hours(4), hours(4) + seconds(1)}), (Numbers{0, 2, 3}))
      << "a single one between is not believed";
}

}  // namespace
}  // namespace maploop::vehicle
