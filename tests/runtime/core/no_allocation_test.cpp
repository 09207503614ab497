// These tests check that the real-time paths do not allocate. They count in replaced global
// operators, so they need an executable of their own.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include "runtime/core/histogram.h"
#include "runtime/core/latest_value.h"
#include "runtime/core/ring.h"

namespace {
std::atomic<long> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, rounded)) return memory;
  throw std::bad_alloc();
}
}  // namespace

// This is not inlined, because GCC would otherwise report a free() of memory from the library's
// operator new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  return counted(size, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace maploop::runtime {
namespace {

using Buffer = std::vector<int>;

TEST(NoAllocation, TheCounterCounts) {
  const long before = allocations;
  Buffer buffer(10);
  EXPECT_GT(allocations, before);
}

TEST(NoAllocation, RingInPlaceAndByCopy) {
  const Buffer prototype(1000);
  Ring<Buffer> ring(100, prototype);
  Buffer taken = prototype, given = prototype;
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) {
    ring.claim()->swap(given);
    ring.publish();
    ring.push(prototype);  // the slot already has the capacity
    ring.front()->swap(taken);
    ring.pop();
    ring.pop(taken);
  }
  EXPECT_EQ(allocations, before);
}

TEST(NoAllocation, LatestValue) {
  const Buffer prototype(1000);
  LatestValue<Buffer> cell(prototype);
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) {
    cell.back() = prototype;
    cell.publish();
    if (i % 2 == 0) cell.latest();
  }
  EXPECT_EQ(allocations, before);
}

TEST(NoAllocation, HistogramRecordsMergesAndAnswers) {
  Histogram histogram, total;
  const long before = allocations;
  for (int i = 0; i < 1000; ++i) histogram.record(Duration(i * i));
  total.merge(histogram);
  const Duration p99 = total.percentile(0.99);
  EXPECT_EQ(allocations, before);
  EXPECT_GT(p99, Duration(900'000));
}

}  // namespace
}  // namespace maploop::runtime
