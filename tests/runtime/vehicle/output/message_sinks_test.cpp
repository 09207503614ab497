// Tests the log, the bus and the hashes, each against LCM's own library.
#include <gtest/gtest.h>

#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "msgs/lcm/conversions.h"
#include "runtime/vehicle/output/channel_hashes.h"
#include "runtime/vehicle/output/lcm_bus.h"
#include "runtime/vehicle/output/log_recorder.h"
#include "tests/support/error_of.h"
#include "tests/support/real_data.h"
#include "tests/support/small_disk.h"

namespace maploop::vehicle {
namespace {

using maploop::testing::error_of;
using maploop::testing::SmallDisk;
using ::testing::AllOf;
using ::testing::HasSubstr;

Message message(const std::vector<std::uint8_t>& data, bool from_data = true) {
  return {"IMU", from_nanoseconds(1'317'042'651'174'740'992), data, from_data};
}

class LogFile : public ::testing::Test {
 protected:
  std::size_t events() const {
    lcm::LogFile log(file, "r");
    std::size_t count = 0;
    while (log.readNextEvent() != nullptr) ++count;
    return count;
  }

  const maploop::testing::TemporaryFolder folder;
  const std::string file = (folder.path() / "a.lcmlog").string();
};

TEST_F(LogFile, IsWhatLcmReads) {
  {
    LogRecorder recorder(file);
    recorder.send(message({1, 2, 3}));
    recorder.send(message({4, 5}));
    EXPECT_EQ(recorder.health().unsent, 0u);
  }
  lcm::LogFile log(file, "r");
  const lcm::LogEvent* first = log.readNextEvent();
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->channel, "IMU");
  EXPECT_EQ(first->timestamp, 1'317'042'651'174'740);
  EXPECT_EQ(first->datalen, 3);
  const lcm::LogEvent* second = log.readNextEvent();
  ASSERT_NE(second, nullptr);
  EXPECT_EQ(second->datalen, 2);
  EXPECT_EQ(static_cast<const std::uint8_t*>(second->data)[1], 5);
  EXPECT_EQ(log.readNextEvent(), nullptr);
}

TEST_F(LogFile, IsOfOneRecording) {
  {
    LogRecorder first(file);
    first.send(message({1, 2, 3}));
    EXPECT_THAT(error_of([&] { const LogRecorder second(file); }),
                AllOf(HasSubstr("a.lcmlog"), HasSubstr("another run")));
    first.send(message({4}));
  }
  EXPECT_EQ(events(), 2u) << "the first is whole";
  const LogRecorder again(file);  // this is allowed once the first has ended
  const LogRecorder nowhere("/dev/null"), nowhere_else("/dev/null");
}

TEST_F(LogFile, OnAFullDiskHoldsEveryEventThatIsNotCountedAsUnsent) {
  LogRecorder recorder(file);
  {
    const SmallDisk disk(100'000);
    for (int i = 0; i < 1000; ++i) recorder.send(message(std::vector<std::uint8_t>(300, 1)));
    recorder.flush();
    const OutputHealth health = recorder.health();
    EXPECT_GT(health.sent, 250u);
    EXPECT_GT(health.unsent, 600u);
    EXPECT_EQ(health.sent + health.unsent, 1000u);
    EXPECT_EQ(events(), health.sent);
    EXPECT_EQ(std::filesystem::file_size(file), health.sent * (28 + 3 + 300)) << "no cut event";
  }
  recorder.send(message({1, 2, 3}));
  recorder.flush();
  EXPECT_EQ(events(), recorder.health().sent) << "there is room again";
}

TEST_F(LogFile, HoldsAllThatWasSentAfterAFlushAndMoreMayFollow) {
  LogRecorder recorder(file);
  for (int i = 0; i < 10; ++i) {
    for (int k = 0; k < 100; ++k) recorder.send(message({1, 2, 3}));
    recorder.flush();
    EXPECT_EQ(events(), 100u * static_cast<unsigned>(i + 1));
  }
}

TEST(LogRecorder, NamesTheFileItCannotWrite) {
  EXPECT_THAT(error_of([&] { LogRecorder recorder("/dev/null/a.lcmlog"); }),
              HasSubstr("/dev/null/a.lcmlog"));
}

TEST(LcmBus, CountsWhatItSent) {
  LcmBus bus("memq://");
  bus.send(message({1, 2, 3}));
  EXPECT_EQ(bus.health().name, "LCM");
  EXPECT_EQ(bus.health().sent, 1u);
  EXPECT_EQ(bus.health().unsent, 0u);
  EXPECT_TRUE(bus.settings().empty()) << "no socket, no buffer";
}

// Nothing leaves this process, because the only message is refused.
TEST(LcmBus, CountsWhatItCouldNotSendAndSaysItsBuffers) {
  std::optional<LcmBus> bus;
  try {
    bus.emplace(LcmBus::default_url);
  } catch (const std::runtime_error& e) {
    GTEST_SKIP() << e.what();
  }
  const std::string too_long(1000, 'X');  // LCM's channel names have at most 63 characters
  Message refused = message({1});
  refused.channel = too_long;
  bus->send(refused);
  EXPECT_EQ(bus->health().unsent, 1u);
  EXPECT_EQ(bus->health().sent, 0u);
  ASSERT_EQ(bus->settings().size(), 2u);
  EXPECT_EQ(bus->settings()[0].name, "LCM: send buffer");
  EXPECT_EQ(bus->settings()[0].asked, "2048 kB");
  EXPECT_EQ(bus->settings()[1].name, "LCM: receive buffers");
}

TEST(LcmBus, NamesTheUrlItCannotOpen) {
  EXPECT_THAT(error_of([&] { LcmBus bus("nonsense://here"); }), HasSubstr("nonsense://here"));
}

TEST(ChannelHashes, DependOnEveryByteAndOnTheOrder) {
  const auto hash = [](const std::vector<std::vector<std::uint8_t>>& messages) {
    ChannelHashes hashes;
    for (const auto& m : messages) hashes.send(message(m));
    return hashes.summary().at("IMU").hash;
  };
  const std::string reference = hash({{1, 2}, {3, 4}});
  EXPECT_EQ(reference.size(), 16u);
  EXPECT_EQ(hash({{1, 2}, {3, 4}}), reference);
  EXPECT_NE(hash({{1, 2}, {3, 5}}), reference);
  EXPECT_NE(hash({{3, 4}, {1, 2}}), reference);
}

TEST(ChannelHashes, WhatSpeaksOfTheRunIsCountedNotHashed) {
  ChannelHashes hashes;
  hashes.send(message({1}, false));
  EXPECT_EQ(hashes.summary().at("IMU").count, 1u);
  EXPECT_EQ(hashes.summary().at("IMU").hash, "");
}

}  // namespace
}  // namespace maploop::vehicle
