#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <thread>

#include "runtime/core/histogram.h"

namespace maploop::runtime {
namespace {

TEST(HistogramConcurrent, ReadersSeeSoundFiguresWhileOneRecords) {
  Histogram histogram;
  constexpr std::uint64_t value_count = 400000;
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < value_count; ++i) {
      histogram.record(Duration(static_cast<std::int64_t>(1000 + i % 1000)));
    }
    done = true;
  });
  std::uint64_t last = 0;
  while (!done) {
    const std::uint64_t count = histogram.count();
    EXPECT_GE(count, last);
    last = count;
    const LatencySummary summary = histogram.summarize("reader");
    if (summary.count > 0) {
      EXPECT_GE(summary.p50, Duration(1000));
      EXPECT_LE(summary.max, Duration(1999));
    }
    EXPECT_LE(summary.p50, summary.p99);
    EXPECT_LE(summary.p99, summary.max);
  }
  writer.join();
  EXPECT_EQ(histogram.count(), value_count);
}

}  // namespace
}  // namespace maploop::runtime
