// A filter saved in the middle of a recorded drive continues with the same bits.
#include <gtest/gtest.h>

#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/recorded_drive.h"
#include "tests/support/broken_archives.h"
#include "tests/support/real_data.h"

namespace maploop::fusion {
namespace {

using namespace maploop::testing;

class FusionArchive : public ::testing::Test {
 protected:
  void SetUp() override {
    MAPLOOP_REQUIRE_REAL_DATA();
    const RecordedDrive drive =
        load_track_drive(real_data(), "2011_09_26_drive_0009", {0.3, radians(0.1)});
    start_ = drive.start;
    measurements_ = as_available(drive.imu, drive.odometry, drive.start);
  }

  void run(ReducedImuFilter& filter, std::size_t from, std::size_t to) const {
    for (std::size_t i = from; i < to; ++i) add(filter, measurements_[i]);
  }

  GnssFix start_;
  std::vector<Measurement> measurements_;
};

void expect_same_state(const ReducedImuFilter& a, const ReducedImuFilter& b, Time t) {
  ArchiveWriter of_a, of_b;
  of_a(a.state_at(t), a.status());
  of_b(b.state_at(t), b.status());
  EXPECT_EQ(of_a.content(), of_b.content());
}

TEST_F(FusionArchive, ALoadedFilterGoesOnWithTheSameBits) {
  const std::size_t half = measurements_.size() / 2;
  ReducedImuFilter first({});
  run(first, 0, half);
  ASSERT_TRUE(first.initialized());
  const Bytes archive = saved(first);
  EXPECT_LT(archive.size(), 830'000u);

  ReducedImuFilter second({});
  run(second, 0, 50);  // loading replaces its state
  load(archive, second);
  EXPECT_EQ(saved(second), archive);
  for (std::size_t i = half; i < measurements_.size(); ++i) {
    EXPECT_EQ(add(first, measurements_[i]), add(second, measurements_[i]));
    expect_same_state(first, second, first.newest());
    // This time is inside the history, which is archived too.
    expect_same_state(first, second, first.newest() - std::chrono::milliseconds(700));
  }
  EXPECT_EQ(saved(first), saved(second));
}

TEST_F(FusionArchive, HeldMeasurementsAndLateOnesComeAlong) {
  // All measurements before the fix that starts the filter are held; a fix in between starts both.
  std::vector<Measurement> fixless;
  for (const Measurement& m : measurements_) {
    if (!std::holds_alternative<GnssFix>(m)) fixless.push_back(m);
  }
  ReducedImuFilter first({}), second({});
  for (std::size_t i = 0; i < 30; ++i) EXPECT_FALSE(add(first, fixless[i]).refused());
  EXPECT_GT(first.status().held, 0u);
  load(saved(first), second);
  EXPECT_EQ(first.add(start_), second.add(start_));
  EXPECT_TRUE(second.initialized());
  // The next measurements come in the wrong order; each is applied inside the history.
  for (const std::size_t i : {33u, 30u, 32u, 31u}) {
    EXPECT_EQ(add(first, fixless[i]), add(second, fixless[i]));
    expect_same_state(first, second, first.newest());
  }
}

TEST_F(FusionArchive, AGuardThatDoubtsAStampGoesOnDoubting) {
  ReducedImuFilter first({}), second({});
  run(first, 0, 100);
  ImuSample ahead;
  ahead.stamp = ahead.available = first.newest() + std::chrono::seconds(2);
  EXPECT_EQ(first.add(ahead).reason, Reason::time_jump);
  load(saved(first), second);
  ahead.stamp += std::chrono::milliseconds(10);  // confirms the previous stamp
  ahead.available = ahead.stamp;
  EXPECT_EQ(second.add(ahead), first.add(ahead));
  EXPECT_EQ(saved(first), saved(second));
}

TEST_F(FusionArchive, RefusesOtherParametersByName) {
  FusionParameters parameters;
  parameters.gyro_noise *= 2.0;
  ReducedImuFilter other(parameters);
  EXPECT_NE(refusal(saved(ReducedImuFilter({})), other).find("gyro_noise = "), std::string::npos);
}

TEST_F(FusionArchive, RefusesBrokenArchives) {
  ReducedImuFilter filter({});
  run(filter, 0, 100);
  expect_refuses_broken(saved(filter), filter);
}

}  // namespace
}  // namespace maploop::fusion
