#include "runtime/core/intake.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace maploop::runtime {
namespace {

struct Letter : Sample {
  char letter = 0;
};

Letter at(std::int64_t ns, char letter) {
  Letter l;
  l.stamp = l.available = from_nanoseconds(ns);
  l.letter = letter;
  return l;
}

struct TwoEdges {
  Doorbell bell;
  Edge<Letter> first{"first", 64, Overflow::keep_all, &bell};
  Edge<Letter> second{"second", 64, Overflow::keep_all, &bell};
  std::string taken;
  Intake intake;

  TwoEdges() {
    intake.add(first, [this](const Letter& l) { taken += l.letter; });
    intake.add(second, [this](const Letter& l) { taken += l.letter; });
  }
};

TEST(Intake, TakesInOrderOfAvailabilityThenOfEdges) {
  TwoEdges e;
  e.second.push(at(1, 'a'), {});
  e.second.push(at(3, 'd'), {});
  e.first.push(at(2, 'b'), {});
  e.first.push(at(3, 'c'), {});
  e.intake.take_until(from_nanoseconds(10));
  EXPECT_EQ(e.taken, "abcd");
}

TEST(Intake, LeavesWhatIsNotYetAvailable) {
  TwoEdges e;
  e.first.push(at(5, 'a'), {});
  e.first.push(at(6, 'b'), {});
  e.intake.take_until(from_nanoseconds(5));
  EXPECT_EQ(e.taken, "a");
  e.intake.take_until(from_nanoseconds(6));
  EXPECT_EQ(e.taken, "ab");
}

TEST(Intake, IsFinishedOnlyWhenEveryEdgeIsFinishedAndEmpty) {
  TwoEdges e;
  e.first.push(at(1, 'a'), {});
  e.first.finish();
  EXPECT_FALSE(e.intake.finished());
  e.second.finish();
  EXPECT_FALSE(e.intake.finished());
  e.intake.take_until(Time::max());
  EXPECT_TRUE(e.intake.finished());
}

TEST(Intake, AWaitTakesWhatIsPromisedSoThatAFullRingCannotHoldItsProducerUp) {
  TwoEdges e;
  e.second.finish();
  constexpr int many = 1000;  // more than the ring holds
  std::stop_source stop;
  const std::stop_callback ring(stop.get_token(), [&] { e.bell.ring(); });
  std::thread producer([&] {
    for (int i = 1; i <= many; ++i) {
      e.first.promise(from_nanoseconds(i - 1));
      e.first.push(at(i, 'a'), stop.get_token());
    }
    e.first.finish();
  });
  std::atomic<bool> waited = false;
  bool complete = false;
  std::thread consumer([&] {
    complete = e.intake.wait(from_nanoseconds(many), e.bell, stop.get_token());
    waited = true;
  });
  const auto bound = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!waited && std::chrono::steady_clock::now() < bound) std::this_thread::yield();
  stop.request_stop();
  producer.join();
  consumer.join();
  EXPECT_TRUE(complete);
  e.intake.take_until(from_nanoseconds(many));
  EXPECT_EQ(e.taken, std::string(many, 'a'));
  EXPECT_EQ(e.intake.taken(), static_cast<std::uint64_t>(many));
}

TEST(Intake, StopEndsTheWaitForAPromiseThatNeverComes) {
  TwoEdges e;
  std::stop_source stop;
  const std::stop_callback ring(stop.get_token(), [&] { e.bell.ring(); });
  bool complete = true;
  std::thread waiter(
      [&] { complete = e.intake.wait(from_nanoseconds(1), e.bell, stop.get_token()); });
  stop.request_stop();
  waiter.join();
  EXPECT_FALSE(complete);
}

TEST(Intake, NamesTheEdgeThatItWaitedForLast) {
  Doorbell bell;
  Edge<Letter> early("early", 8, Overflow::keep_all, &bell);
  Edge<Letter> late("late", 8, Overflow::keep_all, &bell);
  Intake intake;
  // The second edge gives its promise while the first edge's sample is taken, during the wait.
  intake.add(early, [&](const Letter&) { late.promise(from_nanoseconds(5)); });
  intake.add(late, [](const Letter&) {});
  EXPECT_STREQ(intake.waiting(), "waiting for input");
  early.push(at(0, 'a'), {});
  early.promise(from_nanoseconds(5));
  late.promise(from_nanoseconds(0));
  ASSERT_TRUE(intake.wait(from_nanoseconds(5), bell, {}));
  EXPECT_STREQ(intake.waiting(), "waiting for late");
}

// The order of the samples, and the contents of each tick, must not depend on how the producers are
// scheduled.
TEST(Intake, TicksTakeTheSameWhateverTheProducersTiming) {
  std::string reference;
  for (unsigned run = 0; run < 20; ++run) {
    TwoEdges e;
    const auto produce = [&](Edge<Letter>& edge, std::int64_t step, char letter, unsigned seed) {
      std::mt19937 random(seed);
      for (std::int64_t t = step; t < 1000; t += step) {
        edge.promise(from_nanoseconds(t - 1));
        if (random() % 8 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
        edge.push(at(t, letter), {});
      }
      edge.finish();
    };
    std::thread a([&] { produce(e.first, 3, 'a', run); });
    std::thread b([&] { produce(e.second, 7, 'b', run + 100); });
    for (std::int64_t tick = 0; e.intake.wait(from_nanoseconds(tick), e.bell, {}); tick += 10) {
      if (e.intake.finished()) break;
      e.intake.take_until(from_nanoseconds(tick));
      e.taken += '|';
    }
    a.join();
    b.join();
    if (run == 0) reference = e.taken;
    ASSERT_EQ(e.taken, reference);
  }
  EXPECT_EQ(reference.substr(0, 17), "|aaba|abaa|abaaba");
}

}  // namespace
}  // namespace maploop::runtime
