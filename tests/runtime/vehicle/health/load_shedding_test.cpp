#include "runtime/vehicle/health/load_shedding.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include "runtime/vehicle/drivers/shedding_source.h"

namespace maploop::vehicle::load_shedding_test {
namespace {

using ::testing::HasSubstr;

void work(LoadShedding& load, int steps, double share) {
  for (int i = 0; i < steps; ++i) load.worked(share);
}

std::pair<int, int> used(const LoadShedding& load) {
  return {load.points_one_of(), load.pairs_one_of()};
}

TEST(LoadShedding, TakesTheLevelsInTheirOrderAndGoesBack) {
  LoadShedding load({}, true, true);
  EXPECT_EQ(used(load), std::pair(1, 1));
  EXPECT_EQ(load.sentence(), "");
  work(load, 2, 1.0);
  EXPECT_EQ(used(load), std::pair(1, 1)) << "two long steps are no overload";
  work(load, 1, 1.0);
  EXPECT_EQ(used(load), std::pair(2, 1));
  EXPECT_THAT(load.sentence(), HasSubstr("one of 2 points of each scan is used"));
  work(load, 30, 1.0);
  EXPECT_EQ(used(load), std::pair(2, 2)) << "there is no further level";
  EXPECT_THAT(load.sentence(), HasSubstr("of each scan and one of 2 image pairs"));
  work(load, 1000, 0.7);
  EXPECT_EQ(used(load), std::pair(2, 2)) << "neither late nor with room";
  work(load, 100, 0.1);
  EXPECT_EQ(used(load), std::pair(2, 1));
  work(load, 100, 0.1);
  EXPECT_EQ(used(load), std::pair(1, 1));
}

TEST(LoadShedding, SingleLongStepsAreNoOverload) {
  LoadShedding load({}, true, true);
  for (int i = 0; i < 100; ++i) {
    work(load, 1, 3.0);
    work(load, 5, 0.1);
  }
  EXPECT_EQ(used(load), std::pair(1, 1));
}

TEST(LoadShedding, ALevelThatWasNeededAgainSoonIsKeptLonger) {
  LoadShedding load({}, true, false);
  int changes = 0, before = 1;
  for (int step = 0; step < 100'000; ++step) {
    load.worked(load.points_one_of() == 1 ? 1.2 : 0.3);
    changes += load.points_one_of() != before ? 1 : 0;
    before = load.points_one_of();
  }
  EXPECT_GE(changes, 3);
  EXPECT_LE(changes, 80) << "it would change 2000 times";
}

TEST(LoadShedding, LeavesOutOnlyWhatThereIsAndWhatItMay) {
  const auto at_most = [](Shed shed, bool scans, bool images) {
    OverloadParameters parameters;
    parameters.shed = shed;
    LoadShedding load(parameters, scans, images);
    work(load, 100, 5.0);
    return used(load);
  };
  EXPECT_EQ(at_most(Shed::nothing, true, true), std::pair(1, 1));
  EXPECT_EQ(at_most(Shed::scans_first, false, true), std::pair(1, 2));
  EXPECT_EQ(at_most(Shed::scans_first, true, false), std::pair(2, 1));
  EXPECT_EQ(at_most(Shed::scans_first, false, false), std::pair(1, 1));
  OverloadParameters parameters;
  parameters.shed = Shed::images_first;
  LoadShedding load(parameters, true, true);
  work(load, 3, 5.0);
  EXPECT_EQ(used(load), std::pair(1, 2));
}

// Delivers samples at once.
template <class T>
class Fake final : public sensors::LiveSource<T> {
 public:
  bool wait(T& sample, Duration) override {
    sample = {};
    sample.sequence = next_++;
    if constexpr (requires { sample.points; }) {
      for (int i = 0; i < 7; ++i) {
        sample.points.push_back({static_cast<float>(i), 0, 0, 0});
        sample.times.push_back(static_cast<float>(i));
      }
    }
    return true;
  }
  sensors::LiveReport report() const override { return {}; }

 private:
  std::uint64_t next_ = 0;
};

TEST(LoadShedding, SourcesThinScansAndLeavePairsOut) {
  const auto load = std::make_shared<LoadShedding>(OverloadParameters{}, true, true);
  SheddingSource<LidarScan> scans(std::make_unique<Fake<LidarScan>>(), load);
  SheddingSource<StereoPair> pairs(std::make_unique<Fake<StereoPair>>(), load);
  LidarScan scan;
  StereoPair pair;
  ASSERT_TRUE(scans.wait(scan, {}));
  EXPECT_EQ(scan.points.size(), 7u);
  EXPECT_EQ(scans.shed(), 0u);
  work(*load, 100, 2.0);
  ASSERT_TRUE(scans.wait(scan, {}));
  ASSERT_EQ(scan.points.size(), 4u);
  EXPECT_EQ(scans.shed(), 1u);
  EXPECT_EQ(scan.points[1].x, 2.0F);
  EXPECT_EQ(scan.times[1], 2.0F);
  int used = 0;
  for (int i = 0; i < 10; ++i) used += pairs.wait(pair, {}) ? 1 : 0;
  EXPECT_EQ(used, 5);
  EXPECT_EQ(pairs.shed(), 5u);
}

}  // namespace
}  // namespace maploop::vehicle::load_shedding_test
