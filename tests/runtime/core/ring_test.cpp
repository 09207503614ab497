#include "runtime/core/ring.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace maploop::runtime {
namespace {

TEST(Ring, GivesItemsInOrderAcrossManyLaps) {
  Ring<int> ring(3);
  int next_out = 0;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_TRUE(ring.push(i));
    if (i % 3 == 2) {
      for (int k = 0; k < 3; ++k) {
        ASSERT_NE(ring.front(), nullptr);
        EXPECT_EQ(*ring.front(), next_out++);
        ring.pop();
      }
    }
  }
}

TEST(Ring, RefusesExactlyAtCapacityWhereShort) {
  for (std::size_t capacity : {1u, 2u, 3u, 7u, 63u}) {
    Ring<int> ring(capacity);
    for (std::size_t i = 0; i < capacity; ++i) EXPECT_TRUE(ring.push(1)) << capacity;
    EXPECT_EQ(ring.claim(), nullptr);
    EXPECT_EQ(ring.size(), capacity);
    ring.front();
    ring.pop();  // one slot is free at once, though more items wait
    EXPECT_TRUE(ring.push(2)) << capacity;
    EXPECT_FALSE(ring.push(3)) << capacity;
  }
}

// Slots are given back in batches there; the promise is that no item is refused below capacity.
TEST(Ring, NeverRefusesBelowCapacityWhereBatched) {
  for (std::size_t capacity : {64u, 100u, 1000u, 5000u}) {
    Ring<std::uint32_t> ring(capacity);
    const std::size_t most = capacity + std::min(capacity / 8, ring.largest_batch) - 1;
    std::mt19937 random(7);
    std::size_t held = 0;
    std::uint32_t in = 0, out = 0;
    for (int round = 0; round < 2000; ++round) {
      for (std::size_t k = random() % (2 * capacity); k > 0; --k) {
        if (!ring.push(in)) {
          EXPECT_GE(held, capacity);
          break;
        }
        ++in;
        EXPECT_LE(++held, most);
      }
      for (std::size_t k = random() % (2 * capacity); k > 0; --k) {
        std::uint32_t item = 0;
        if (!ring.pop(item)) break;
        ASSERT_EQ(item, out++);
        --held;
      }
      ASSERT_EQ(ring.size(), held);
    }
    EXPECT_EQ(ring.pushed(), ring.popped() + ring.size());
  }
}

TEST(Ring, RandomPushesAndPopsMatchADeque) {
  Ring<std::string> ring(5);
  std::deque<std::string> expected;
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    if (random() % 2 == 0) {
      const std::string item = std::to_string(i) + " a text too long for the string's own buffer";
      EXPECT_EQ(ring.push(item), expected.size() < 5);
      if (expected.size() < 5) expected.push_back(item);
    } else {
      std::string item;
      ASSERT_EQ(ring.pop(item), !expected.empty());
      if (!expected.empty()) {
        EXPECT_EQ(item, expected.front());
        expected.pop_front();
      }
    }
    ASSERT_EQ(ring.size(), expected.size());
  }
}

TEST(Ring, ClaimAgainWithoutPublishIsTheSameSlot) {
  Ring<int> ring(2);
  int* slot = ring.claim();
  EXPECT_EQ(ring.claim(), slot);
  EXPECT_EQ(ring.front(), nullptr) << "claimed, not published";
  EXPECT_EQ(ring.size(), 0u);
  *slot = 4;
  ring.publish();
  EXPECT_NE(ring.claim(), slot);
  EXPECT_EQ(ring.front(), slot) << "in place";
  EXPECT_EQ(ring.front(), slot) << "until pop";
}

TEST(Ring, LastFreeSlotIsVisibleAtOnceAfterTheRingWasFoundFull) {
  Ring<int> ring(1);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(ring.push(i));
    ASSERT_FALSE(ring.push(-1));
    int item = -1;
    ASSERT_TRUE(ring.pop(item));
    EXPECT_EQ(item, i);
    ASSERT_EQ(ring.front(), nullptr);
  }
}

TEST(Ring, SlotsKeepTheirBuffers) {
  using Buffer = std::vector<std::uint8_t>;
  Ring<Buffer> ring(2, Buffer(1000));
  const auto* first = ring.claim()->data();
  ring.publish();
  Buffer taken(1000);
  const auto* given = taken.data();
  ASSERT_TRUE(ring.pop(taken));
  EXPECT_EQ(taken.data(), first) << "the buffer moves out";
  ring.push(Buffer(1000));
  ring.pop(taken);
  EXPECT_EQ(ring.claim()->data(), given) << "and the caller's takes its place";
}

TEST(Ring, EverySlotStartsAsThePrototype) {
  for (std::size_t capacity : {3u, 100u}) {
    Ring<std::vector<int>> ring(capacity, std::vector<int>(17, 5));
    for (std::size_t i = 0; i < capacity; ++i) {
      ASSERT_NE(ring.claim(), nullptr);
      EXPECT_EQ(*ring.claim(), std::vector<int>(17, 5));
      ring.publish();
    }
  }
}

TEST(Ring, HoldsWhatCannotBeCopied) {
  Ring<std::unique_ptr<int>> ring(2);
  *ring.claim() = std::make_unique<int>(8);
  ring.publish();
  std::unique_ptr<int> taken;
  ASSERT_TRUE(ring.pop(taken));
  EXPECT_EQ(*taken, 8);
}

struct Counted {
  static inline int alive = 0;
  Counted() { ++alive; }
  Counted(const Counted&) { ++alive; }
  Counted& operator=(const Counted&) = default;
  ~Counted() { --alive; }
};

TEST(Ring, ConstructsAndDestroysEachSlotOnce) {
  {
    Ring<Counted> ring(5);
    EXPECT_EQ(Counted::alive, 5);
    Counted item;
    for (int i = 0; i < 12; ++i) {
      ring.push(item);
      ring.pop(item);
    }
    EXPECT_EQ(Counted::alive, 6);
  }
  EXPECT_EQ(Counted::alive, 0);
}

TEST(Ring, ItemsOfACacheLineOrMoreShareNone) {
  struct Item {
    std::array<char, 80> bytes;
  };
  Ring<Item> ring(4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(ring.claim()) % cache_line, 0u);
    ring.publish();
  }
}

TEST(Ring, HonoursAnAlignmentAboveItsOwn) {
  struct alignas(512) Item {
    int value;
  };
  Ring<Item> ring(3);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(ring.claim()) % 512, 0u);
    ring.publish();
  }
}

TEST(Ring, CapacityZeroIsRefused) {
  EXPECT_THROW(Ring<int>(0), std::invalid_argument);
  EXPECT_THROW(Ring<int>(0, 1), std::invalid_argument);
}

TEST(Ring, CapacityBeyondMemoryIsRefused) {
  using Page = std::array<char, 4096>;
  constexpr auto most_slots = static_cast<std::size_t>(-1);
  EXPECT_THROW(Ring<Page>{most_slots / 2}, std::length_error);
  EXPECT_THROW(Ring<char>{most_slots}, std::length_error) << "also where a batch on top would wrap";
}

// The constructor of this type does not write its bytes, so only the ring itself can have mapped
// them.
struct Untouched {
  Untouched() {}
  std::array<char, 4096> bytes;
};

TEST(Ring, FirstLapFaultsNoPage) {
  constexpr std::size_t slot_count = 4096;  // 16 MiB
  Ring<Untouched> ring(slot_count);
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  for (std::size_t i = 0; i < slot_count; ++i) {
    ring.claim()->bytes[0] = 1;
    ring.publish();
  }
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_minflt - before.ru_minflt, 64) << "of " << slot_count << " pages";
}

#ifndef NDEBUG
TEST(RingDeathTest, PublishWithoutClaimAndPopWithoutFrontAreCaught) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  Ring<int> ring(1);
  EXPECT_DEATH(ring.pop(), "pop\\(\\) without front");
  ring.push(1);
  EXPECT_DEATH(ring.publish(), "publish\\(\\) without claim");
}
#endif

}  // namespace
}  // namespace maploop::runtime
