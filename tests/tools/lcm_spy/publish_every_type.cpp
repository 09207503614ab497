// Publishes one message of every type on the vehicle's channels, ten times a second, for a bounded
// time:   publish_every_type SECONDS [LCM_URL]
#include <charconv>
#include <chrono>
#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <string>
#include <string_view>
#include <thread>

#include "msgs/lcm/conversions.h"

namespace maploop {
namespace {

constexpr double maximum_seconds = 600.0;

template <typename T>
T sample(int tick) {
  T result;
  result.stamp = from_nanoseconds(1'317'042'272'000'000'000) + tick * from_seconds(0.1);
  result.available = result.stamp + from_seconds(0.05);
  result.sequence = static_cast<std::uint64_t>(tick);
  return result;
}

Deadlines deadlines(Time stamp) {
  LatencySummary fusion{.name = "fusion",
                        .count = 1480,
                        .misses = 1,
                        .deadline = from_seconds(2e-3),
                        .guilty = "woken late"};
  fusion.p50 = from_seconds(40e-6);
  LatencySummary path{.name = "camera to state", .count = 143, .guilty = ""};
  return {.stamp = stamp, .threads = {fusion}, .paths = {path}};
}

Health health(Time stamp) {
  ThreadHealth fusion{
      .name = "fusion", .scheduling = "fifo 50", .count = 1480, .rate = 100.0, .failure = ""};
  RingHealth ring{
      .name = "imu -> fusion", .pushed = 144, .popped = 143, .held = 1, .capacity = 256};
  return {.stamp = stamp,
          .threads = {fusion},
          .rings = {ring},
          .refusals = {{"fusion", "duplicate", 2}},
          .outputs = {{"LCM", 1480, 0}},
          .sensors = {{"imu", "udp://127.0.0.1:3000", true, 1, 1480, 0, "", {}}},
          .settings = {{"fusion: scheduling", "fifo 50", "fifo 50", Verdict::granted, "", ""}},
          .degraded = {"no real-time priority"}};
}

bool publish_all(lcm::LCM& lcm, int tick) {
  bool sent = true;
  const auto publish = [&](const std::string& channel, const auto& message) {
    const auto encoded = to_lcm(message);
    sent = lcm.publish(channel, &encoded) == 0 && sent;
  };
  auto state = sample<NavState>(tick);
  state.status = NavStatus::aided;
  state.forward_speed = 11.7;
  publish("NAV_STATE", state);
  publish("NAV_PROTECTION", sample<NavProtection>(tick));
  publish("VO", sample<RelativeMotion>(tick));
  publish("LIDAR_ODOMETRY", sample<LidarMotion>(tick));
  publish("ODOMETRY", sample<RelativeMotion>(tick));
  publish("IMU", sample<ImuSample>(tick));
  auto match = sample<MapMatch>(tick);
  match.on_road = true;
  match.way_id = 30982311;
  match.candidate_count = 1;
  const auto matched = to_lcm(match, {"Moltkestrasse (way 30982311), P 97 %", {}});
  sent = lcm.publish("MAP_MATCH", &matched) == 0 && sent;
  publish("MAP_DOUBT", sample<MapDoubt>(tick));
  publish("MAP_FEEDBACK", sample<MapFeedback>(tick));
  publish("GNSS_FIX", sample<GnssFix>(tick));
  auto ppp = sample<PppState>(tick);
  ppp.satellites.resize(1);
  publish("PPP_STATE", ppp);
  auto preview = sample<Preview>(tick);
  preview.tracks.resize(1);
  preview.points.resize(1);
  publish("PREVIEW", preview);
  publish("WHEEL_SPEED", sample<WheelSpeed>(tick));
  publish("TRUTH", sample<ReferencePose>(tick));
  publish("DEADLINES", deadlines(state.stamp));
  publish("HEALTH", health(state.stamp));
  publish("SELF_CALIBRATION",
          SelfCalibration{state.stamp, {{"rear axle", "m", 0.8, 0.1, 0.5, true}}});
  return sent;
}

int run(double seconds, const std::string& url) {
  lcm::LCM lcm(url);
  if (!lcm.good()) {
    std::fprintf(stderr,
                 "publish_every_type: LCM cannot start; is there a route for its multicast?\n");
    return 1;
  }
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  for (int tick = 0; Clock::now() < end; ++tick) {
    if (!publish_all(lcm, tick)) {
      std::fprintf(stderr, "publish_every_type: message %d was not sent\n", tick);
      return 1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return 0;
}

}  // namespace
}  // namespace maploop

int main(int argc, char** argv) {
  double seconds = 0.0;
  if (argc == 2 || argc == 3) {
    const std::string_view text = argv[1];
    std::from_chars(text.data(), text.data() + text.size(), seconds);
  }
  if (!(seconds > 0.0 && seconds <= maploop::maximum_seconds)) {
    std::fprintf(stderr, "usage: publish_every_type SECONDS [LCM_URL], at most 600 s\n");
    return 2;
  }
  return maploop::run(seconds, argc == 3 ? argv[2] : "");
}
