#include "runtime/vehicle/drivers/prefetched_source.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <stop_token>
#include <thread>
#include <utility>

#include "tests/runtime/vehicle/fake_sensors.h"

namespace maploop::vehicle {
namespace {

struct Loaded {
  Loaded(std::unique_ptr<sensors::Source<ImuSample>> recorded, std::size_t depth)
      : source("loader", {}, std::move(recorded), depth, stop.get_token(), nullptr) {}

  std::stop_source stop;
  PrefetchedSource<ImuSample> source;
};

auto samples(std::size_t count) {
  return testing::fake_source<ImuSample>(count, [](std::uint64_t, ImuSample&) {});
}

TEST(PrefetchedSource, GivesEachSampleOnceAndInOrder) {
  Loaded loaded(samples(100), 3);
  std::uint64_t expected = 0;
  for (ImuSample sample; loaded.source.next(sample);) EXPECT_EQ(sample.sequence, expected++);
  EXPECT_EQ(expected, 100u);
  EXPECT_EQ(loaded.source.report().delivered, 100u);
}

TEST(PrefetchedSource, ReportsAfterAStopTheSampleThatWasBeingDecoded) {
  runtime::Doorbell decoding;
  std::stop_source stop;
  const std::uint32_t heard = decoding.listen();
  PrefetchedSource<ImuSample> source(
      "loader", {},
      testing::fake_source<ImuSample>(100,
                                      [&](std::uint64_t, ImuSample&) {
                                        decoding.ring();
                                        while (!stop.stop_requested()) std::this_thread::yield();
                                      }),
      3, stop.get_token(), nullptr);
  decoding.wait(heard);
  stop.request_stop();
  EXPECT_EQ(source.report().delivered, 1u);
}

TEST(PrefetchedSource, AStopEndsALoaderThatNobodyReads) {
  Loaded loaded(samples(100), 3);
  ImuSample sample;
  EXPECT_TRUE(loaded.source.next(sample));
  loaded.stop.request_stop();
  EXPECT_GE(loaded.source.report().delivered, 1u);
  EXPECT_LE(loaded.source.report().delivered, 5u);
}

TEST(PrefetchedSource, ThrowsWhatEndedTheLoader) {
  Loaded loaded(testing::broken(samples(100), 2), 3);
  ImuSample sample;
  EXPECT_TRUE(loaded.source.next(sample));
  EXPECT_TRUE(loaded.source.next(sample));
  EXPECT_THROW(loaded.source.next(sample), std::runtime_error);
}

}  // namespace
}  // namespace maploop::vehicle
