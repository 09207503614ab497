// Tests that measuring allocates nothing. It counts by replacing the global operator new, and so
// needs an executable of its own.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "runtime/vehicle/health/thread_meter.h"

namespace {
std::atomic<long> allocations{0};
}  // namespace

// This is not inlined, or GCC would warn that free() gets memory of the library's operator new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace maploop::vehicle {
namespace {

using std::chrono::milliseconds;

TEST(MeterNoAllocation, TicksMissesStallsAndTicksLeftOut) {
  const runtime::DataClock clock = runtime::DataClock::paced(1.0);
  ThreadMeter meter(stages::fusion);
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) {
    const MonotonicTime due{i * milliseconds(10)};
    const Time stamp = from_nanoseconds(i);
    meter.woke({stamp, i % 10 == 0 ? 5U : 0U}, clock, due, due + milliseconds(i % 7));
    meter.ran(milliseconds(i % 3));
    meter.latency().record({stamp, milliseconds(i), {{{"running", milliseconds(i)}, {}, {}}}});
    meter.latency().record_shift(milliseconds(i), milliseconds(10));
  }
  const long during = allocations - before;
  EXPECT_EQ(during, 0);
  EXPECT_EQ(meter.latency().miss_count(), 997u) << "of 2 ms";
  EXPECT_EQ(meter.latency().summary().worst.size(), 10u);
  EXPECT_GT(allocations, before) << "the counter counts: a summary allocates";
}

}  // namespace
}  // namespace maploop::vehicle
