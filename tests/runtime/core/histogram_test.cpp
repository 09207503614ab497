#include "runtime/core/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace maploop::runtime {
namespace {

// Computes the nearest rank on the sorted values themselves.
std::int64_t exact_percentile(std::vector<std::int64_t> values, double fraction) {
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(fraction * static_cast<double>(values.size()) - 1e-6);
  return values[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

void expect_close_to_exact(const std::vector<std::int64_t>& values) {
  Histogram histogram;
  for (std::int64_t value : values) histogram.record(Duration(value));
  ASSERT_EQ(histogram.count(), values.size());
  EXPECT_EQ(histogram.max().count(), *std::max_element(values.begin(), values.end()));
  EXPECT_EQ(histogram.min().count(), *std::min_element(values.begin(), values.end()));
  EXPECT_EQ(histogram.percentile(1.0), histogram.max());
  for (double fraction : {0.0, 0.001, 0.01, 0.07, 0.1, 0.25, 0.5, 0.9, 0.99, 0.999, 0.9999, 1.0}) {
    const std::int64_t exact = exact_percentile(values, fraction);
    const std::int64_t reported = histogram.percentile(fraction).count();
    EXPECT_GE(reported, exact) << fraction;
    EXPECT_LE(static_cast<double>(reported), static_cast<double>(exact) * (1.0 + 1.0 / 128))
        << fraction;
  }
}

TEST(Histogram, PercentilesOfRandomLatencies) {
  std::mt19937_64 random(3);
  const std::vector<std::function<double()>> latencies = {
      [&] { return std::uniform_real_distribution(0.0, 1e6)(random); },
      [&] { return std::exp(std::uniform_real_distribution(0.0, std::log(1.3e11))(random)); },
      [&] { return std::lognormal_distribution(10.0, 2.0)(random); },
      [&] { return std::exponential_distribution(1e-5)(random); },
  };
  for (const auto& latency : latencies) {
    for (std::size_t n : {1u, 2u, 10u, 100u, 1001u, 50000u}) {
      std::vector<std::int64_t> values(n);
      for (auto& value : values) value = static_cast<std::int64_t>(latency());
      expect_close_to_exact(values);
    }
  }
}

// The values lie on either side of every relevant bucket edge: powers of two and their neighbours.
TEST(Histogram, PercentilesAtTheEdgesOfTheOctaves) {
  std::vector<std::int64_t> values;
  for (int power = 0; power <= 36; ++power) {
    for (std::int64_t step : {-1, 0, 1}) values.push_back((std::int64_t{1} << power) + step);
  }
  values.push_back(Histogram::highest_duration.count());
  expect_close_to_exact(values);
  for (std::int64_t value : values) expect_close_to_exact({value});
}

TEST(Histogram, PercentilesOfTwoFarValues) {
  std::vector<std::int64_t> values(999, 1);
  values.push_back(100'000'000'000);
  expect_close_to_exact(values);
  Histogram histogram;
  for (std::int64_t value : values) histogram.record(Duration(value));
  EXPECT_EQ(histogram.percentile(0.999), Duration(1)) << "rank 999 of 1000";
  EXPECT_EQ(histogram.percentile(0.9991), std::chrono::seconds(100)) << "rank 1000";
}

TEST(Histogram, BelowTwoHundredFiftySixNanosecondsIsExact) {
  for (int value = 0; value < 256; ++value) {
    Histogram histogram;
    histogram.record(Duration(value));
    histogram.record(std::chrono::seconds(1));  // so that max() does not limit it
    EXPECT_EQ(histogram.percentile(0.5), Duration(value));
  }
}

TEST(Histogram, EmptyAnswersZero) {
  const Histogram histogram;
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.percentile(0.99), Duration{});
  EXPECT_EQ(histogram.min(), Duration{});
  EXPECT_EQ(histogram.max(), Duration{});
}

TEST(Histogram, BeyondTheRangeIsCountedAndItsMaximumKept) {
  Histogram histogram;
  histogram.record(Histogram::highest_duration);
  histogram.record(Histogram::highest_duration + Duration(1));
  histogram.record(Duration::max());
  EXPECT_EQ(histogram.count(), 3u);
  EXPECT_EQ(histogram.above_range(), 2u);
  EXPECT_EQ(histogram.percentile(0.3), Histogram::highest_duration);
  EXPECT_EQ(histogram.percentile(0.5), Duration::max());
  EXPECT_EQ(histogram.max(), Duration::max());
}

TEST(Histogram, NegativeIsCountedAsZero) {
  Histogram histogram;
  histogram.record(Duration(-5));
  histogram.record(Duration::min());
  histogram.record(Duration(7));
  EXPECT_EQ(histogram.count(), 3u);
  EXPECT_EQ(histogram.below_range(), 2u);
  EXPECT_EQ(histogram.min(), Duration::min());
  EXPECT_EQ(histogram.percentile(0.5), Duration{});
  EXPECT_EQ(histogram.percentile(1.0), Duration(7));
}

TEST(Histogram, FractionOutsideZeroToOneIsRefused) {
  const Histogram histogram;
  for (double fraction : {-0.01, 1.01, 99.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(histogram.percentile(fraction), std::invalid_argument);
  }
}

TEST(Histogram, MergedIsAsIfRecordedInOne) {
  std::mt19937_64 random(5);
  Histogram whole, first, second;
  for (int i = 0; i < 10000; ++i) {
    const Duration value(static_cast<std::int64_t>(random() % 200'000'000'000));
    whole.record(value);
    (i % 3 == 0 ? first : second).record(value);
  }
  first.merge(second);
  first.merge(Histogram());
  EXPECT_EQ(first.count(), whole.count());
  EXPECT_EQ(first.above_range(), whole.above_range());
  EXPECT_GT(whole.above_range(), 0u);
  EXPECT_EQ(first.min(), whole.min());
  EXPECT_EQ(first.max(), whole.max());
  for (int percent = 0; percent <= 100; ++percent) {
    EXPECT_EQ(first.percentile(percent / 100.0), whole.percentile(percent / 100.0));
  }
}

void expect_same(const HistogramData& a, const HistogramData& b) {
  EXPECT_EQ(a.below_range, b.below_range);
  EXPECT_EQ(a.above_range, b.above_range);
  EXPECT_EQ(a.min, b.min);
  EXPECT_EQ(a.max, b.max);
  ASSERT_EQ(a.buckets.size(), b.buckets.size());
  for (std::size_t i = 0; i < a.buckets.size(); ++i) {
    EXPECT_EQ(a.buckets[i].lowest, b.buckets[i].lowest);
    EXPECT_EQ(a.buckets[i].count, b.buckets[i].count);
  }
}

TEST(Histogram, TwoExportsMergeAsIfRecordedInOne) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> exponent(0.0, std::log(3e11));
  Histogram whole, first, second, imported;
  for (int i = 0; i < 20000; ++i) {
    const Duration value(static_cast<std::int64_t>(std::exp(exponent(random))) - 5);
    whole.record(value);
    (i % 3 == 0 ? first : second).record(value);
  }
  imported.merge(first.data());
  imported.merge(second.data());
  imported.merge(HistogramData{});
  EXPECT_GT(whole.below_range(), 0u);
  EXPECT_GT(whole.above_range(), 0u);
  EXPECT_EQ(imported.count(), 20000u);
  expect_same(imported.data(), whole.data());
}

TEST(Histogram, EveryBucketIsExportedByItsLowestValue) {
  Histogram histogram;
  for (std::int64_t value : {0, 255, 256, 257, 258, 511, 512, 515, 516}) {
    histogram.record(Duration(value));
  }
  std::vector<std::int64_t> lowest;
  for (const auto& bucket : histogram.data().buckets) lowest.push_back(bucket.lowest.count());
  EXPECT_EQ(lowest, (std::vector<std::int64_t>{0, 255, 256, 258, 510, 512, 516}));
}

TEST(Histogram, DataThatAreNoHistogramAreRefusedWhole) {
  Histogram histogram;
  using Buckets = std::vector<HistogramData::Bucket>;
  for (const Buckets& buckets :
       {Buckets{{Duration(257), 1}}, Buckets{{Duration(-1), 1}}, Buckets{{Duration(4), 0}},
        Buckets{{Duration(4), 1}, {Duration(4), 1}}, Buckets{{Duration(5), 1}, {Duration(4), 1}},
        Buckets{{Histogram::highest_duration + Duration(1), 1}}, Buckets{{Duration(4), ~0ULL}}}) {
    HistogramData data;
    data.buckets = buckets;
    EXPECT_THROW(histogram.merge(data), std::invalid_argument);
  }
  HistogramData more_negative_than_there_are;
  more_negative_than_there_are.below_range = 1;
  EXPECT_THROW(histogram.merge(more_negative_than_there_are), std::invalid_argument);
  EXPECT_EQ(histogram.count(), 0u);
}

TEST(Histogram, SummaryHoldsItsPercentiles) {
  Histogram histogram;
  for (int i = 1; i <= 1000; ++i) histogram.record(std::chrono::microseconds(i));
  const LatencySummary summary = histogram.summarize("fusion");
  EXPECT_EQ(summary.name, "fusion");
  EXPECT_EQ(summary.count, 1000u);
  EXPECT_EQ(summary.p50, histogram.percentile(0.5));
  EXPECT_EQ(summary.p90, histogram.percentile(0.9));
  EXPECT_EQ(summary.p99, histogram.percentile(0.99));
  EXPECT_EQ(summary.p999, histogram.percentile(0.999));
  EXPECT_EQ(summary.max, std::chrono::milliseconds(1));
  expect_same(summary.histogram, histogram.data());
}

// A 10 ms task that stalls for 100 ms hides nine releases, which waited 90, 80, ... 10 ms.
TEST(Histogram, OmittedWaitsAreThoseOfTheReleasesDuringAStall) {
  Histogram histogram;
  const std::vector<std::int64_t> stalls = {10, 13, 14, 99, 100, 101, 251};  // exact below 256
  std::vector<std::int64_t> expected;
  for (std::int64_t stall : stalls) {
    histogram.record_omitted(Duration(stall), Duration(7));
    for (std::int64_t left = stall - 7; left >= 7; left -= 7) expected.push_back(left);
  }
  ASSERT_EQ(histogram.count(), expected.size());
  EXPECT_EQ(histogram.min().count(), *std::min_element(expected.begin(), expected.end()));
  EXPECT_EQ(histogram.max().count(), *std::max_element(expected.begin(), expected.end()));
  for (int percent = 1; percent <= 100; ++percent) {
    EXPECT_EQ(histogram.percentile(percent / 100.0).count(),
              exact_percentile(expected, percent / 100.0));
  }
}

TEST(Histogram, OmittedWaitsOfATinyPeriodAreBoundedWork) {
  Histogram histogram;
  for (int power = 0; power < 40; ++power) {
    histogram.record_omitted(Duration(std::int64_t{1} << power), Duration(1));
  }
  // There are 2 - 1, 4 - 1, ... up to 2^36 - 1 waits, and 2^37 - 2 for each of the three values
  // beyond the range.
  const double expected = 1.37e11 + 3 * 1.374e11;
  EXPECT_NEAR(static_cast<double>(histogram.count()), expected, expected / 100);
}

}  // namespace
}  // namespace maploop::runtime
