#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <random>
#include <thread>
#include <vector>

#include "runtime/core/ring.h"

namespace maploop::runtime {
namespace {

// Sends 0, 1, 2, ... through `ring`. Each side pauses now and then, so that the ring is full, empty
// and in between; the consumer checks that nothing is lost, torn, doubled or out of order.
template <typename T, typename Fill, typename Value>
void send_and_check(Ring<T>& ring, std::uint64_t items, Fill fill, Value value_of) {
  std::thread producer([&] {
    std::mt19937 random(1);
    for (std::uint64_t i = 0; i < items;) {
      if (T* slot = ring.claim()) {
        fill(*slot, i++);
        ring.publish();
      } else {
        std::this_thread::yield();
      }
      if (random() % 1024 == 0) std::this_thread::yield();
    }
  });
  std::mt19937 random(2);
  std::uint64_t wrong = 0;
  for (std::uint64_t i = 0; i < items;) {
    if (T* item = ring.front()) {
      if (value_of(*item) != i++) ++wrong;
      ring.pop();
    } else {
      std::this_thread::yield();
    }
    if (random() % 1024 == 0) std::this_thread::yield();
  }
  producer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(ring.front(), nullptr);
  EXPECT_EQ(ring.pushed(), items);
  EXPECT_EQ(ring.popped(), items);
}

// Each turn of a full or empty ring waits for the other thread, and beside a load a turn takes
// milliseconds. So a small ring passes fewer items.
std::uint64_t items_for(std::size_t capacity, std::uint64_t most) {
  return std::min<std::uint64_t>(most, 5000 * capacity);
}

TEST(RingConcurrent, SmallItemsArriveInOrder) {
  for (std::size_t capacity : {1u, 2u, 7u, 64u, 100u, 4096u}) {
    Ring<std::uint64_t> ring(capacity);
    send_and_check(
        ring, items_for(capacity, 200000), [](std::uint64_t& slot, std::uint64_t i) { slot = i; },
        [](const std::uint64_t& item) { return item; });
  }
}

TEST(RingConcurrent, LargeItemsAreNeverTorn) {
  using Item = std::array<std::uint64_t, 32>;
  for (std::size_t capacity : {1u, 3u, 64u, 256u}) {
    Ring<Item> ring(capacity);
    send_and_check(
        ring, items_for(capacity, 50000), [](Item& slot, std::uint64_t i) { slot.fill(i); },
        [](const Item& item) {
          for (std::uint64_t word : item) {
            if (word != item.front()) return ~std::uint64_t{0};
          }
          return item.front();
        });
  }
}

TEST(RingConcurrent, BuffersSwapInAndOut) {
  using Buffer = std::vector<std::uint64_t>;
  Ring<Buffer> ring(4, Buffer(64));
  Buffer spare(64);
  send_and_check(
      ring, items_for(4, 50000),
      [&spare](Buffer& slot, std::uint64_t i) {
        spare.assign(64, i);
        slot.swap(spare);
      },
      [](const Buffer& item) { return item.size() == 64 ? item.back() : ~std::uint64_t{0}; });
}

// One item at a time goes to and fro: an item must be visible although no other follows it, and so
// must a freed slot although no other is freed.
TEST(RingConcurrent, PingPongNeedsNoFurtherCall) {
  for (std::size_t capacity : {1u, 64u, 1000u}) {
    Ring<int> there(capacity), back(capacity);
    constexpr int round_count = 5000;
    std::thread echo([&] {
      for (int i = 0; i < round_count; ++i) {
        int item = 0;
        while (!there.pop(item)) std::this_thread::yield();
        while (!back.push(item)) std::this_thread::yield();
      }
    });
    int wrong = 0;
    for (int i = 0; i < round_count; ++i) {
      int item = -1;
      while (!there.push(i)) std::this_thread::yield();
      while (!back.pop(item)) std::this_thread::yield();
      if (item != i) ++wrong;
    }
    echo.join();
    EXPECT_EQ(wrong, 0) << capacity;
  }
}

TEST(RingConcurrent, AMonitorSeesConsistentCounts) {
  Ring<int> ring(100);
  std::atomic<bool> done{false};
  std::thread producer([&] {
    for (int i = 0; i < 200000;) {
      ring.push(i) ? void(++i) : std::this_thread::yield();
    }
    done = true;
  });
  std::thread consumer([&] {
    int item = 0;
    while (!done || ring.front() != nullptr) {
      if (!ring.pop(item)) std::this_thread::yield();
    }
  });
  std::uint64_t last_popped = 0;
  while (!done) {
    const std::uint64_t popped = ring.popped();
    EXPECT_GE(ring.pushed(), popped);
    EXPECT_GE(popped, last_popped);
    EXPECT_LE(ring.size(), 100u + 100u / 8);
    last_popped = popped;
    std::this_thread::yield();
  }
  producer.join();
  consumer.join();
  EXPECT_EQ(ring.size(), 0u);
}

}  // namespace
}  // namespace maploop::runtime
