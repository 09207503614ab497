// These tests check that the real-time paths do not allocate.
#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "runtime/core/histogram.h"
#include "runtime/core/latest_value.h"
#include "runtime/core/ring.h"
#include "runtime/core/trace.h"
#include "tests/support/counted_allocations.h"

namespace maploop::runtime {
namespace {

using Buffer = std::vector<int>;

// Returns the allocations of `work`.
template <class Work>
long allocations(Work&& work) {
  const long before = testing::thread_allocations();
  work();
  return testing::thread_allocations() - before;
}

TEST(NoAllocation, TheCounterCounts) {
  EXPECT_GT(allocations([] {
              Tracer tracer({.events_per_thread = 10});
              tracer.thread("stereo");
            }),
            0);
}

TEST(NoAllocation, RingInPlaceAndByCopy) {
  const Buffer prototype(1000);
  Ring<Buffer> ring(100, prototype);
  Buffer taken = prototype, given = prototype;
  EXPECT_EQ(allocations([&] {
              for (int i = 0; i < 1000; ++i) {
                ring.claim()->swap(given);
                ring.publish();
                ring.push(prototype);  // the slot already has the capacity
                ring.front()->swap(taken);
                ring.pop();
                ring.pop(taken);
              }
            }),
            0);
}

TEST(NoAllocation, LatestValue) {
  const Buffer prototype(1000);
  LatestValue<Buffer> cell;
  const auto use = [&] {
    for (int i = 0; i < 1000; ++i) {
      cell.back() = prototype;
      cell.publish();
      if (i % 2 == 0) cell.latest();
    }
  };
  use();  // each of the three buffers gets its memory
  EXPECT_EQ(allocations(use), 0);
}

TEST(NoAllocation, HistogramRecordsMergesAndAnswers) {
  Histogram histogram, total;
  Duration p99{};
  EXPECT_EQ(allocations([&] {
              for (int i = 0; i < 1000; ++i) histogram.record(Duration(i * i));
              total.merge(histogram);
              p99 = total.percentile(0.99);
            }),
            0);
  EXPECT_GT(p99, Duration(900'000));
}

void record_some(TraceBuffer* buffer) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    TraceSpan span(buffer, "process");
    span.start_flow({"camera", i});
    span.step_flow({"camera", i});
    span.end_flow({"camera", i});
    trace_instant(buffer, "late");
    trace_counter(buffer, "held", 1.0);
  }
}

TEST(NoAllocation, TraceRecordsAndDrops) {
  for (const int room : {6000, 1}) {
    Tracer tracer({.events_per_thread = room});
    TraceBuffer& buffer = tracer.thread("stereo");
    EXPECT_EQ(allocations([&] { record_some(&buffer); }), 0);
    EXPECT_EQ(buffer.recorded(), static_cast<std::size_t>(room));
    EXPECT_EQ(buffer.dropped(), 6000u - static_cast<std::uint64_t>(room));
  }
}

TEST(NoAllocation, TheWriterOfATraceNeedsNoMoreForAThousandTimesTheEvents) {
  const auto written = [](int events) {
    Tracer tracer({.events_per_thread = events});
    TraceBuffer& buffer = tracer.thread("stereo");
    for (int i = 0; i < events; ++i) trace_instant(&buffer, "late");
    return allocations([&] { tracer.write("/dev/null"); });
  };
  EXPECT_EQ(written(100), written(100'000));
}

}  // namespace
}  // namespace maploop::runtime
