// Tests the messages that `maploop replay` sends, received by another process with LCM's own
// library. Run it in a separate network namespace.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <maploop_lcm/replay_control_t.hpp>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "msgs/lcm/conversions.h"
#include "runtime/vehicle/output/lcm_bus.h"
#include "tests/support/process.h"
#include "tests/support/real_data.h"

namespace maploop {
namespace {

class Listener {
 public:
  Listener() : lcm_(vehicle::LcmBus::default_url) {
    lcm_.subscribe(".*", &Listener::hear, this);
    thread_ = std::thread([this] {
      while (!stop_) lcm_.handleTimeout(50);
    });
  }
  ~Listener() { stop(); }

  void stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  // Whether the player publishes a state that satisfies `wanted`, within a bounded time. `ask` is
  // called now and every two seconds, because a busy machine may lose a message of UDP.
  bool hears(
      const std::function<bool(const maploop_lcm::replay_control_t&)>& wanted,
      const std::function<void()>& ask = [] {}) {
    for (int i = 0; i < 1200; ++i) {
      if (i % 40 == 0) ask();
      {
        const std::lock_guard lock(mutex_);
        for (const auto& state : states_) {
          if (wanted(state)) return true;
        }
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }
  std::string run() {  // run of the last state
    const std::lock_guard lock(mutex_);
    return states_.empty() ? "" : states_.back().run;
  }
  std::map<std::string, int> counts;  // after stop()
  NavState last_state;

 private:
  void hear(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    ++counts[channel];
    if (channel == "REPLAY_CONTROL") hear_state(*buffer);
    if (channel != "NAV_STATE") return;
    maploop_lcm::nav_state_t message;
    ASSERT_EQ(message.decode(buffer->data, 0, static_cast<int>(buffer->data_size)),
              static_cast<int>(buffer->data_size));
    last_state = from_lcm(message);
  }

  void hear_state(const lcm::ReceiveBuffer& buffer) {
    maploop_lcm::replay_control_t message;
    ASSERT_EQ(message.decode(buffer.data, 0, static_cast<int>(buffer.data_size)),
              static_cast<int>(buffer.data_size));
    const std::lock_guard lock(mutex_);
    if (message.kind == maploop_lcm::replay_control_t::STATE) states_.push_back(message);
  }

  std::mutex mutex_;
  std::vector<maploop_lcm::replay_control_t> states_;
  lcm::LCM lcm_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(LcmTraffic, EveryChannelArrivesAndDecodes) {
  MAPLOOP_REQUIRE_DRIVE();
  const testing::TemporaryFolder folder;
  const std::string file = (folder.path() / "result.json").string();
  Listener listener;
  const testing::ProcessResult result = testing::run(
      {testing::maploop_command(), "replay", testing::drive_0013().string(), "--json", file});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  listener.stop();
  ASSERT_EQ(result.status, 0) << result.error;

  const auto sent = nlohmann::json::parse(std::ifstream(file))["channels"];
  EXPECT_EQ(sent.size(), 13u);
  for (const auto& [channel, summary] : sent.items()) {
    const int count = summary["count"];
    EXPECT_LE(listener.counts[channel], count) << channel;
    // UDP may lose messages on a busy machine; at most a tenth may be missing.
    EXPECT_GE(listener.counts[channel], count - 1 - count / 10) << channel;
  }
  EXPECT_EQ(listener.last_state.status, NavStatus::aided);
  EXPECT_NEAR(listener.last_state.forward_speed, 11.0, 5.0);
}

TEST(LcmTraffic, ThePlayerObeysAnotherProcess) {
  MAPLOOP_REQUIRE_DRIVE();
  using Control = maploop_lcm::replay_control_t;
  Listener listener;
  testing::Process replay(
      {testing::maploop_command(), "replay", testing::drive_0013().string(), "--paused"});
  EXPECT_TRUE(listener.hears([](const Control& s) { return s.paused != 0; }));
  lcm::LCM lcm(vehicle::LcmBus::default_url);
  const std::string run = listener.run();
  const auto command = [&](std::int8_t kind, double value) {
    Control message{};
    message.run = run;
    message.kind = kind;
    message.value = value;
    lcm.publish("REPLAY_CONTROL", &message);
  };
  const auto position = [](const Control& s) {
    return 1e-9 * static_cast<double>(s.position_ns - s.first_ns);
  };
  for (const double aim : {6.0, 3.0}) {
    const auto arrived = [&](const Control& s) {
      return s.seeking == 0 && s.paused != 0 && std::abs(position(s) - aim) < 0.05;
    };
    EXPECT_TRUE(listener.hears(arrived, [&] { command(Control::SEEK, aim); })) << aim;
  }
  const auto refused = [](const Control& s) {
    return s.refused.find("seek to 100 s") != std::string::npos;
  };
  EXPECT_TRUE(listener.hears(refused, [&] { command(Control::SEEK, 100.0); }));
  for (int i = 0; i < 30 && replay.runs(); ++i) {
    command(Control::QUIT, 0.0);
    std::this_thread::sleep_for(std::chrono::seconds(2));
  }
  const testing::ProcessResult result = replay.wait();
  EXPECT_EQ(result.status, 130) << result.error;
  EXPECT_EQ(result.out.find("Interrupted after "), 0u) << result.out;
}

}  // namespace
}  // namespace maploop
