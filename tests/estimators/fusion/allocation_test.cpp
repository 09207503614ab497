// The filter allocates all its memory at construction. The test counts every allocation of this
// program, including Eigen's own, which do not use operator new.
#include <gtest/gtest.h>

#include <utility>

#include "msgs/archive.h"
#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"
#include "tests/support/counted_allocations.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;

TEST(Allocation, ThereIsNoneAfterConstruction) {
  if (!counts_allocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  const SyntheticDrive drive({}, 10.0, test_origin());
  std::vector<Measurement> all =
      as_available(drive.imu(100.0), drive.odometry(10.0), drive.fix(0.0));
  FusionParameters parameters;
  parameters.history_length = parameters.imu_bridge = 1.0;  // so that events also leave the history
  const long before_construction = thread_allocations();
  ReducedImuFilter filter(parameters, test_origin());
  const long before = thread_allocations();
  EXPECT_GT(before, before_construction) << "the counter does not count";
  RelativeMotion bad = std::get<RelativeMotion>(
      all.back().index() == 1 ? all.back() : Measurement(drive.odometry(10.0).back()));
  const long before_use = thread_allocations();
  for (const Measurement& m : all) {
    add(filter, m);
    filter.state_at(stamp_of(m) + from_seconds(0.01));
  }
  bad.translation.setConstant(50.0);
  filter.add(bad);
  filter.status();
  EXPECT_EQ(thread_allocations(), before_use);
  EXPECT_EQ(filter.state_at(SyntheticDrive::at(10.0))->odometry_applied, 100u);
}

TEST(Allocation, SavingIntoMemoryThatIsThereTakesNoMore) {
  if (!counts_allocations()) GTEST_SKIP() << "the sanitizer owns malloc";
  const SyntheticDrive drive({}, 10.0, test_origin());
  ReducedImuFilter filter({}, test_origin());
  for (const Measurement& m :
       as_available(drive.imu(100.0), drive.odometry(10.0), drive.fix(0.0))) {
    add(filter, m);
  }
  Bytes memory;
  memory.reserve(filter.largest_archive());
  const long before = thread_allocations();
  ArchiveWriter writer(std::move(memory));
  writer(filter);
  EXPECT_EQ(thread_allocations(), before);
  EXPECT_GT(writer.content().size(), 200'000u) << "two seconds of history at 110 Hz";
}

}  // namespace
}  // namespace maploop::fusion
