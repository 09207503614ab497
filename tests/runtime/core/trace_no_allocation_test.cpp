#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

#include "runtime/core/trace.h"

namespace {
std::atomic<std::size_t> allocations{0};

void* counted(std::size_t bytes, std::size_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  const std::size_t whole = (bytes + alignment - 1) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, whole)) return memory;
  throw std::bad_alloc();
}

// This is not inlined, because the compiler does not see the allocation and would warn about the
// free.
[[gnu::noinline]] void release(void* memory) {
  std::free(memory);
}
}  // namespace

void* operator new(std::size_t bytes) {
  return counted(bytes, alignof(std::max_align_t));
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}

namespace maploop::runtime {
namespace {

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

TEST(TraceAllocation, TheCountWorks) {
  const std::size_t before = allocations;
  Tracer tracer({.events_per_thread = 10});
  tracer.thread("stereo");
  EXPECT_GT(allocations, before);
}

TEST(TraceAllocation, RecordingAllocatesNothing) {
  Tracer tracer({.events_per_thread = 6000});
  TraceBuffer& buffer = tracer.thread("stereo");
  const std::size_t before = allocations;
  record_some(&buffer);
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(buffer.recorded(), 6000u);
  EXPECT_EQ(buffer.dropped(), 0u);
}

TEST(TraceAllocation, DroppingAllocatesNothing) {
  Tracer tracer({.events_per_thread = 1});
  TraceBuffer& buffer = tracer.thread("stereo");
  const std::size_t before = allocations;
  record_some(&buffer);
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(buffer.dropped(), 5999u);
}

TEST(TraceAllocation, TheWriterNeedsNoMoreForAThousandTimesTheEvents) {
  const auto written = [](int events) {
    Tracer tracer({.events_per_thread = events});
    TraceBuffer& buffer = tracer.thread("stereo");
    for (int i = 0; i < events; ++i) trace_instant(&buffer, "late");
    const std::size_t before = allocations;
    tracer.write("/dev/null");
    return allocations - before;
  };
  EXPECT_EQ(written(100), written(100'000));
}

}  // namespace
}  // namespace maploop::runtime
