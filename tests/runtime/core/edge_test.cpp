#include "runtime/core/edge.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace maploop::runtime {
namespace {

struct Number : Sample {
  int value = 0;
};

Number at(std::int64_t ns, int value = 0) {
  Number n;
  n.stamp = n.available = from_nanoseconds(ns);
  n.value = value;
  return n;
}

TEST(Edge, DropsTheNewestWhenFullAndCountsThem) {
  Edge<Number> edge("a -> b", 2, Overflow::drop_newest, nullptr);
  const std::size_t room = edge.health().capacity;
  for (std::size_t i = 0; i < room + 3; ++i) edge.push(at(static_cast<std::int64_t>(i)), {});

  const RingHealth health = edge.health();
  EXPECT_EQ(health.pushed, room + 3);
  EXPECT_EQ(health.lost, 3u);
  EXPECT_EQ(health.held, room);
  EXPECT_EQ(edge.front()->stamp, from_nanoseconds(0)) << "the oldest stay";
}

TEST(Edge, KeepAllWaitsForRoomAndLosesNothing) {
  Edge<Number> edge("a -> b", 2, Overflow::keep_all, nullptr);
  constexpr int count = 2000;
  std::thread producer([&] {
    for (int i = 0; i < count; ++i) edge.push(at(i, i), {});
  });
  for (int expected = 0; expected < count;) {
    if (const Number* n = edge.front()) {
      ASSERT_EQ(n->value, expected++);
      edge.pop();
    } else {
      std::this_thread::yield();
    }
  }
  producer.join();
  const RingHealth health = edge.health();
  EXPECT_EQ(health.pushed, static_cast<std::uint64_t>(count));
  EXPECT_EQ(health.popped, static_cast<std::uint64_t>(count));
  EXPECT_EQ(health.lost + health.held, 0u);
}

TEST(Edge, StopFreesAProducerThatWaitsForRoomAndCountsItsSampleAsLost) {
  Edge<Number> edge("a -> b", 1, Overflow::keep_all, nullptr);
  std::stop_source stop;
  std::thread producer([&] {
    for (int i = 0; !stop.stop_requested(); ++i) edge.push(at(i), stop.get_token());
  });
  while (edge.health().held < edge.health().capacity) std::this_thread::yield();
  stop.request_stop();
  producer.join();
  const RingHealth health = edge.health();
  EXPECT_EQ(health.pushed, health.popped + health.lost + health.held);
  EXPECT_LE(health.lost, 1u);
}

TEST(Edge, NobodyWaitsForAReaderThatHasEndedAndTheLossIsCounted) {
  Edge<Number> edge("a -> b", 1, Overflow::keep_all, nullptr);
  std::stop_source stop;
  edge.push(at(0), stop.get_token());
  std::atomic<bool> freed = false;
  std::thread producer([&] {
    edge.push(at(1), stop.get_token());
    freed = true;
  });
  edge.abandon();
  const auto bound = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!freed && std::chrono::steady_clock::now() < bound) std::this_thread::yield();
  EXPECT_TRUE(freed);
  stop.request_stop();
  producer.join();
  EXPECT_EQ(edge.health().held, 1u);
  EXPECT_EQ(edge.health().lost, 1u);
}

TEST(Edge, PromisesOnlyGrow) {
  Edge<Number> edge("a -> b", 1, Overflow::keep_all, nullptr);
  EXPECT_EQ(edge.promised(), Time::min());
  edge.promise(from_nanoseconds(10));
  edge.promise(from_nanoseconds(5));
  EXPECT_EQ(edge.promised(), from_nanoseconds(10));
  edge.finish();
  EXPECT_EQ(edge.promised(), Time::max());
}

TEST(Edge, SlotsAreFilledInPlaceAndReused) {
  struct Big : Sample {
    std::vector<int> buffer;
  };
  Big prototype;
  prototype.buffer.resize(1000);
  Edge<Big> edge("a -> b", 1, Overflow::keep_all, nullptr, prototype);
  const int* first = nullptr;
  edge.push({}, [&](Big& slot) {
    first = slot.buffer.data();
    EXPECT_EQ(slot.buffer.size(), 1000u);
  });
  EXPECT_EQ(edge.front()->buffer.data(), first);
}

}  // namespace
}  // namespace maploop::runtime
