#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "runtime/core/ring.h"
#include "runtime/core/trace.h"
#include "tests/runtime/core/trace_document.h"

namespace maploop::runtime {
namespace {

using nlohmann::json;

// Checks that the spans of one thread form a tree: each lies within the one in which it started.
void expect_nested(const TraceDocument& trace) {
  std::map<int, std::vector<std::int64_t>> open;  // ends of the open spans, by thread
  for (const json& span : trace.events("X")) {
    auto& ends = open[span.at("tid").get<int>()];
    while (!ends.empty() && ends.back() <= start_of(span)) ends.pop_back();
    if (!ends.empty()) {
      ASSERT_LE(end_of(span), ends.back()) << span;
    }
    ends.push_back(end_of(span));
  }
}

TEST(TraceConcurrent, EveryEventOfManyThreadsIsRecordedOrCounted) {
  constexpr int thread_count = 4, turn_count = 1'000, events_aturn = 4, buffer_capacity = 2'400;
  Tracer tracer({.events_per_thread = buffer_capacity});
  std::vector<std::thread> threads;
  for (int i = 0; i < thread_count; ++i) {
    threads.emplace_back([&tracer, i] {
      TraceBuffer* buffer = &tracer.thread("thread " + std::to_string(i));
      for (int turn = 0; turn < turn_count; ++turn) {
        TraceSpan outer(buffer, "outer");
        TraceSpan inner(buffer, "inner");
        trace_instant(buffer, "instant");
        trace_counter(buffer, "counter", turn);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(tracer.recorded(), thread_count * buffer_capacity);
  EXPECT_EQ(tracer.dropped(), thread_count * (turn_count * events_aturn - buffer_capacity));
  const TraceDocument trace(tracer);
  EXPECT_EQ(trace.events("C").size(), thread_count * buffer_capacity / events_aturn);
  expect_nested(trace);
}

TEST(TraceConcurrent, WrittenWhileThreadsRecordATraceIsWholeAndNested) {
  Tracer tracer({.events_per_thread = 1'000});
  std::atomic<bool> stop{false};
  std::vector<std::thread> threads;
  for (int i = 0; i < 2; ++i) {
    threads.emplace_back([&tracer, &stop] {
      TraceBuffer* buffer = &tracer.thread("busy");
      while (!stop) {
        TraceSpan outer(buffer, "outer");
        { TraceSpan first(buffer, "first"); }
        TraceSpan second(buffer, "second");
        std::this_thread::yield();
      }
    });
  }
  std::size_t before = 0;
  for (int i = 0; i < 5; ++i) {
    const TraceDocument trace(tracer);
    expect_nested(trace);
    EXPECT_GE(trace.events("X").size(), before);
    before = trace.events("X").size();
  }
  stop = true;
  for (std::thread& thread : threads) thread.join();
}

TEST(TraceConcurrent, EveryFlowThroughARingPointsForward) {
  constexpr std::uint64_t sample_count = 500;
  Tracer tracer({});
  Ring<std::uint64_t> ring(16);
  std::thread producer([&] {
    TraceBuffer* buffer = &tracer.thread("camera");
    for (std::uint64_t i = 0; i < sample_count; ++i) {
      TraceSpan span(buffer, "release");
      span.start_flow({"camera", i});
      while (!ring.push(i)) std::this_thread::yield();
    }
  });
  std::thread consumer([&] {
    TraceBuffer* buffer = &tracer.thread("stereo");
    for (std::uint64_t i = 0; i < sample_count; ++i) {
      TraceSpan span(buffer, "process");
      std::uint64_t sample = 0;
      while (!ring.pop(sample)) std::this_thread::yield();
      span.end_flow({"camera", sample});
    }
  });
  // Every flow that has arrived in a trace written meanwhile has also left.
  for (int i = 0; i < 3; ++i) {
    const TraceDocument trace(tracer);
    EXPECT_GE(trace.events("s").size(), trace.events("f").size());
  }
  producer.join();
  consumer.join();
  const TraceDocument trace(tracer);
  std::map<std::string, std::int64_t> left;
  for (const json& start : trace.events("s")) {
    EXPECT_TRUE(left.emplace(start.at("id").get<std::string>(), start_of(start)).second);
  }
  ASSERT_EQ(left.size(), sample_count);
  for (const json& end : trace.events("f")) {
    const auto start = left.find(end.at("id").get<std::string>());
    ASSERT_NE(start, left.end());
    EXPECT_LE(start->second, start_of(end));
    left.erase(start);
  }
  EXPECT_TRUE(left.empty());
}

}  // namespace
}  // namespace maploop::runtime
