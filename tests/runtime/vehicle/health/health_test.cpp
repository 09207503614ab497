// Tests what HEALTH reports while the vehicle runs, read from a bus in memory.
#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "msgs/lcm/conversions.h"
#include "tests/runtime/vehicle/driven.h"
#include "tests/runtime/vehicle/memory_bus.h"

namespace maploop::vehicle {
namespace {

using ::testing::Contains;
using testing::fake_sensors;
using ::testing::HasSubstr;
using testing::MemoryBus;

VehicleConfig without_fixes() {
  VehicleConfig config;
  set_configuration(config, "VO-L-RI");
  return config;
}

VehicleReport run(MemoryBus& bus, double speed, const VehicleConfig& config = without_fixes()) {
  return testing::drive({.sensors = fake_sensors(5.0),
                         .speed = speed,
                         .config = config,
                         .sinks = {&bus},
                         .prepared = {{{"locked memory", "all", "none", Verdict::refused, "no room",
                                        "add memory"}}}})
      .report;
}

std::vector<Health> said(const MemoryBus& bus) {
  std::vector<Health> all;
  for (const auto& message : bus.decoded<maploop_lcm::health_t>("HEALTH")) {
    all.push_back(from_lcm(message));
  }
  return all;
}

using Counts = std::map<std::pair<std::string, std::string>, std::uint64_t>;

Counts refusals(const Health& health) {
  Counts counts;
  for (const RefusalCount& r : health.refusals) counts[{r.stage, r.reason}] = r.count;
  return counts;
}

TEST(Health, CountsRefusalsByReasonWhileTheVehicleRuns) {
  MemoryBus bus;
  const VehicleReport report = run(bus, 5.0);
  const std::vector<Health> health = said(bus);
  ASSERT_GE(health.size(), 5u);
  for (std::size_t i = 1; i < health.size(); ++i) {
    const Counts before = refusals(health[i - 1]), after = refusals(health[i]);
    for (const auto& [key, count] : before) EXPECT_GE(after.at(key), count) << key.second;
  }
  const Counts last = refusals(health.back());
  EXPECT_EQ(last, refusals(report.health));
  std::uint64_t stereo = 0;
  for (const auto& [key, count] : last) stereo += key.first == "stereo" ? count : 0;
  EXPECT_EQ(stereo, 50u) << "there is nothing to see in these images";
  EXPECT_EQ((last.at({"fusion", "odometry reports a failure"})), 50u);
  EXPECT_EQ((last.at({"fusion", "GNSS after the start (GNSS+ in the configuration uses it)"})), 4u);
  Counts early = refusals(health[1]);  // a reason that has not occurred yet is missing
  EXPECT_LT((early[{"fusion", "odometry reports a failure"}]), 50u);
}

TEST(Health, CountsWhatABusDidNotTake) {
  MemoryBus bus(300);
  const VehicleReport report = run(bus, 0.0);
  EXPECT_EQ(bus.messages().size(), 300u);
  ASSERT_EQ(report.health.outputs.size(), 3u);
  const OutputHealth& output = report.health.outputs.back();
  EXPECT_EQ(output.name, "memory");
  EXPECT_EQ(output.sent, 300u);
  EXPECT_GT(output.unsent, 300u);
  EXPECT_THAT(report.health.degraded, Contains(HasSubstr("memory did not take ")));
}

TEST(Health, NamesEverySettingThatWasAskedFor) {
  MemoryBus bus;
  VehicleConfig config;
  config.scheduling.fusion.priority = 99;
  config.scheduling.publisher.policy = runtime::SchedulingPolicy::other;
  config.scheduling.publisher.nice = 5;
  run(bus, 50.0, config);
  const std::vector<Health> health = said(bus);
  ASSERT_FALSE(health.empty());
  std::map<std::string, RealtimeSetting> settings;
  for (const RealtimeSetting& s : health.front().settings) settings[s.name] = s;
  EXPECT_EQ(settings["locked memory"].remedy, "add memory");
  EXPECT_EQ(settings["fusion: scheduling"].asked, "fifo 99");
  EXPECT_EQ(settings["publisher: scheduling"].granted, "other nice 5");
  EXPECT_EQ(settings.count("health: scheduling"), 1u) << "of the thread that says it";
  EXPECT_THAT(health.front().degraded,
              Contains("locked memory is none, not all: no room; add memory"));
  for (const ThreadHealth& thread : health.front().threads) {
    EXPECT_EQ(thread.scheduling, settings[thread.name + ": scheduling"].granted);
  }
}

TEST(Health, OnVirtualTimeNoThreadAsksForAnything) {
  MemoryBus bus;
  const VehicleReport report = run(bus, 0.0);
  for (const RealtimeSetting& s : report.health.settings) {
    if (!s.name.ends_with(": scheduling")) continue;
    EXPECT_EQ(s.asked, "as inherited") << s.name;
  }
}

}  // namespace
}  // namespace maploop::vehicle
