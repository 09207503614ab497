#include "tests/tools/log/small_log.h"

#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <utility>

#include "msgs/input_file.h"
#include "msgs/input_limits.h"
#include "msgs/lcm/conversions.h"
#include "runtime/vehicle/output/log_recorder.h"

namespace maploop::lcm_log {

using schema::encoded;

std::vector<std::uint8_t> nav_state_bytes(double east) {
  NavState state;
  state.position_enu = {east, 2.0, 3.0};
  state.status = NavStatus::aided;
  return encoded(to_lcm(state));
}

std::vector<std::uint8_t> map_match_bytes() {
  MapMatch match;
  match.stamp = from_nanoseconds(1000 * test_start);
  match.on_road = true;
  match.vehicle_enu = {10.0, 20.0};
  match.covariance = Eigen::Vector2d(4.0, 1.0).asDiagonal();
  match.matched_enu = {13.0, 20.0};
  match.half_width = 2.5;
  match.bend = 0.2;
  match.candidate_count = 1;
  match.candidates[0].probability = 0.75;
  return encoded(
      to_lcm(match, {.explanation = "", .candidates = {{"Main Street, way 7", {}, {}}}}));
}

std::vector<std::uint8_t> health_bytes(int threads) {
  Health health;
  health.threads.resize(static_cast<std::size_t>(threads));
  for (auto& thread : health.threads) thread.name = "fusion";
  return encoded(to_lcm(health));
}

std::vector<std::uint8_t> unknown_bytes(std::size_t size, std::uint8_t seed) {
  std::vector<std::uint8_t> bytes(size, seed);
  for (std::size_t i = 0; i < 8 && i < size; ++i) bytes[i] = static_cast<std::uint8_t>(77 * i + 5);
  return bytes;
}

std::vector<TestEvent> small_drive() {
  std::vector<TestEvent> events;
  const auto add = [&](const char* channel, std::vector<std::uint8_t> data) {
    events.push_back({channel, test_start + 10'000 * std::ssize(events), std::move(data)});
  };
  for (int i = 0; i < 24; i += 6) {
    add("NAV_STATE", nav_state_bytes(0.1 * i));
    add("HEALTH", health_bytes((i + 1) % 4));
    add("IMU", encoded(to_lcm(ImuSample{})));
    add("NAV_STATE", nav_state_bytes(0.1 * (i + 3)));
    add("CAMERA_TRIGGER", unknown_bytes(40, static_cast<std::uint8_t>(i)));
    add("X", i == 0 ? std::vector<std::uint8_t>{} : encoded(to_lcm(RelativeMotion{})));
  }
  return events;
}

void record(const path& file, const std::vector<TestEvent>& events) {
  vehicle::LogRecorder recorder(file.string());
  for (const TestEvent& event : events) {
    recorder.send({event.channel, from_nanoseconds(event.time_us * 1000), event.data, true});
  }
  EXPECT_EQ(recorder.health().unsent, 0U);
}

std::vector<TestEvent> read_with_lcm(const path& file) {
  lcm::LogFile log(file.string(), "r");
  EXPECT_TRUE(log.good()) << file;
  std::vector<TestEvent> events;
  if (!log.good()) return events;
  std::int64_t number = 0;
  for (const lcm::LogEvent* e = log.readNextEvent(); e != nullptr; e = log.readNextEvent()) {
    EXPECT_EQ(e->eventnum, number++);
    const auto* data = static_cast<const std::uint8_t*>(e->data);
    events.push_back({e->channel, e->timestamp, {data, data + e->datalen}});
  }
  return events;
}

std::vector<std::uint8_t> read_bytes(const path& file) {
  std::vector<std::uint8_t> bytes;
  maploop::read_bytes(file, input_limits::mebibyte, bytes);
  return bytes;
}

void write_bytes(const path& file, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
}

void write_compressed(const path& file, const std::vector<std::uint8_t>& bytes) {
  const std::string packed = gzip({bytes.begin(), bytes.end()});
  write_bytes(file, {packed.begin(), packed.end()});
}

std::vector<std::size_t> event_offsets(const std::vector<TestEvent>& events) {
  std::vector<std::size_t> offsets{0};
  for (const TestEvent& event : events) {
    offsets.push_back(offsets.back() + 28 + event.channel.size() + event.data.size());
  }
  return offsets;
}

}  // namespace maploop::lcm_log
