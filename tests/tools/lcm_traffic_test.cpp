// What `maploop replay` puts on the wire, seen by another process with LCM's own library. Run it in
// a network namespace of its own.
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "msgs/lcm/conversions.h"
#include "runtime/vehicle/lcm_bus.h"
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
  std::map<std::string, int> counts;  // after stop()
  NavState last_state;

 private:
  void hear(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    ++counts[channel];
    if (channel != "NAV_STATE") return;
    maploop_lcm::nav_state_t message;
    ASSERT_EQ(message.decode(buffer->data, 0, static_cast<int>(buffer->data_size)),
              static_cast<int>(buffer->data_size));
    last_state = from_lcm(message);
  }

  lcm::LCM lcm_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(LcmTraffic, EveryChannelArrivesAndDecodes) {
  MAPLOOP_REQUIRE_DRIVE();
  const testing::TemporaryFolder folder;
  const std::string file = (folder.path() / "result.json").string();
  Listener listener;
  const testing::ProcessResult result =
      testing::run({MAPLOOP_COMMAND, "replay", testing::drive_0013().string(), "--json", file});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  listener.stop();
  ASSERT_EQ(result.status, 0) << result.error;

  const auto sent = nlohmann::json::parse(std::ifstream(file))["channels"];
  EXPECT_EQ(sent.size(), 8u);
  for (const auto& [channel, summary] : sent.items()) {
    const int count = summary["count"];
    EXPECT_LE(listener.counts[channel], count) << channel;
    // UDP promises nothing on a busy machine; what is missing must stay the exception.
    EXPECT_GE(listener.counts[channel], count - 1 - count / 10) << channel;
  }
  EXPECT_EQ(listener.last_state.status, NavStatus::aided);
  EXPECT_NEAR(listener.last_state.forward_speed, 11.0, 5.0);
}

}  // namespace
}  // namespace maploop
