// Tests bounds of execution, and the promises made of a run by hand.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <string>

#include "runtime/core/histogram.h"
#include "tools/analyze/analysis.h"

namespace maploop::analyze {
namespace {

LatencySummary summary(const std::string& name, double ms, int count = 100) {
  runtime::Histogram histogram;
  for (int i = 0; i < count; ++i) histogram.record(from_seconds(1e-3 * ms));
  return histogram.summarize(name);
}

TEST(ExecutionBound, FewStepsGetAMarginOnTheLongest) {
  const ExecutionBound bound = execution_bound(summary("a", 2.0), {.margin = 1.5});
  EXPECT_FALSE(bound.fitted);
  EXPECT_NEAR(bound.bound, 1.5 * bound.observed, 1e-9);
  EXPECT_NEAR(bound.observed, 2.0, 0.1);
}

TEST(ExecutionBound, OfAnExponentialTailIsWhatIsExceededOnceInAMillion) {
  std::mt19937 random(3);
  std::exponential_distribution<double> excess(1.0);  // 1/ms
  runtime::Histogram histogram;
  for (int i = 0; i < 20'000; ++i) histogram.record(from_seconds(1e-3 * (1.0 + excess(random))));
  const ExecutionBound bound = execution_bound(histogram.summarize("a"), {});
  ASSERT_TRUE(bound.fitted) << bound.distance;
  EXPECT_NEAR(bound.bound, 1.0 + std::log(1e6), 4.0);
  EXPECT_GE(bound.bound, bound.observed);
  EXPECT_GT(bound.exceedances, 1500u);
}

TEST(ExecutionBound, TwoClustersHaveNoTailThatCouldBeFitted) {
  runtime::Histogram histogram;
  for (int i = 0; i < 1000; ++i) {
    const double ms = i % 8 != 0 ? 1.0 : (i % 16 == 0 ? 5.0 : 9.0 + 0.5 * (i % 3));
    histogram.record(from_seconds(1e-3 * ms));
  }
  const ExecutionBound bound = execution_bound(histogram.summarize("a"), {});
  EXPECT_FALSE(bound.fitted);
  EXPECT_NEAR(bound.bound, 1.2 * bound.observed, 1e-9);
}

// A run of ten seconds with the fusion, and with camera and stereo for each of 100 images.
profile::Profile run(double fusion_ms, double stereo_ms, double wake_up_ms,
                     double camera_ms = 0.3) {
  profile::Profile p;
  p.health.elapsed = 10.0;
  const auto add = [&](const std::string& name, std::uint64_t count, double ms, Duration deadline) {
    ThreadHealth thread;
    thread.name = name;
    thread.count = count;
    p.health.threads.push_back(thread);
    p.execution.push_back(summary(name, ms));
    p.wake_up.push_back(summary(name, wake_up_ms));
    if (deadline == Duration::zero()) return;
    p.threads.push_back({summary(name, ms + wake_up_ms)});
    p.threads.back().deadline = deadline;
  };
  add("camera", 100, camera_ms, {});
  add("fusion", 1000, fusion_ms, std::chrono::milliseconds(2));
  p.period_jitter = {summary("fusion", wake_up_ms)};
  add("stereo", 100, stereo_ms, std::chrono::milliseconds(50));
  return p;
}

const Promise& promise(const Analysis& analysis, const std::string& name) {
  for (const Promise& p : analysis.threads)
    if (p.name == name) return p;
  throw std::out_of_range(name);
}

TEST(Analysis, PromisesWhatFitsAndIsNeverBelowWhatWasMeasured) {
  const Analysis analysis = analyze(run(0.2, 20.0, 0.1), {}, {.cpus = 1, .execution = {}});
  EXPECT_TRUE(analysis.advice.empty()) << to_text(analysis);
  EXPECT_EQ(analysis.threads.front().name, "camera") << "the highest priority first";
  EXPECT_NEAR(promise(analysis, "camera").execution.bound, 0.36, 1e-3);
  for (const char* name : {"fusion", "stereo"}) {
    const Promise& p = promise(analysis, name);
    EXPECT_TRUE(p.kept()) << name;
    EXPECT_GE(p.response, p.measured) << name;
    EXPECT_LT(p.response, 1.2 * p.measured + 2.0) << name;
  }
  EXPECT_EQ(to_json(analysis)["threads"]["fusion"]["kept"], true);
}

TEST(Analysis, SaysWhatWouldKeepADeadline) {
  const auto advice = [](const profile::Profile& p, int cpus) {
    const Analysis analysis = analyze(p, {}, {.cpus = cpus, .execution = {}});
    return analysis.advice.empty() ? std::string() : analysis.advice.front();
  };
  EXPECT_NE(advice(run(3.0, 20.0, 0.1), 2).find("its own step takes up to 3.6"), std::string::npos);
  EXPECT_NE(advice(run(0.2, 20.0, 5.0), 2).find("see maploop doctor"), std::string::npos);
  const profile::Profile busy = run(0.2, 30.0, 0.1, 12.0);
  EXPECT_NE(advice(busy, 1).find("priority 71 would do"), std::string::npos) << advice(busy, 1);
}

TEST(Analysis, IsNeverBelowWhatWasMeasuredEvenIfAStepWaitedForTheOneBefore) {
  profile::Profile p = run(0.2, 20.0, 0.1);
  p.threads.back().max = std::chrono::milliseconds(180);
  const Analysis analysis = analyze(p, {}, {.cpus = 2, .execution = {}});
  EXPECT_GE(promise(analysis, "stereo").response, 180.0);
  EXPECT_FALSE(promise(analysis, "stereo").kept());
}

TEST(Analysis, AWakeUpThatWaitedForOthersIsNotTheirs) {
  profile::Profile p = run(0.2, 20.0, 0.1);
  p.wake_up.back() = summary("stereo", 7.0);
  const Analysis analysis = analyze(p, {}, {.cpus = 2, .execution = {}});
  EXPECT_LT(promise(analysis, "fusion").response, 2.0);
  EXPECT_GT(promise(analysis, "stereo").response, 27.0);
}

TEST(Analysis, AsksToRecordAgainWhatAnOlderVersionRecorded) {
  profile::Profile p = run(0.2, 20.0, 0.1);
  p.execution.erase(p.execution.begin());
  try {
    analyze(p, {}, {.cpus = 2, .execution = {}});
    FAIL() << "no driver's execution was measured";
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("'camera'"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("record it again"), std::string::npos) << e.what();
  }
}

TEST(Analysis, RefusesARunOnVirtualTime) {
  profile::Profile p = run(0.2, 20.0, 0.1);
  p.period_jitter.clear();
  EXPECT_THROW(analyze(p, {}, {.cpus = 1, .execution = {}}), std::invalid_argument);
}

}  // namespace
}  // namespace maploop::analyze
