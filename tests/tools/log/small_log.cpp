#include "tests/tools/log/small_log.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>
#include <iterator>
#include <lcm/lcm-cpp.hpp>

#include "msgs/lcm/conversions.h"
#include "runtime/vehicle/output/log_recorder.h"

namespace maploop::lcm_log {
namespace {

template <class Lcm>
std::vector<std::uint8_t> encode(const Lcm& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  EXPECT_GT(message.encode(bytes.data(), 0, static_cast<int>(bytes.size())), 0);
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> nav_state_bytes(double east) {
  NavState state;
  state.position_enu = {east, 2.0, 3.0};
  state.status = NavStatus::aided;
  return encode(to_lcm(state));
}

std::vector<std::uint8_t> health_bytes(int threads) {
  Health health;
  health.threads.resize(static_cast<std::size_t>(threads));
  for (auto& thread : health.threads) thread.name = "fusion";
  return encode(to_lcm(health));
}

std::vector<std::uint8_t> unknown_bytes(std::size_t size, std::uint8_t seed) {
  std::vector<std::uint8_t> bytes(size, seed);
  for (std::size_t i = 0; i < 8 && i < size; ++i) bytes[i] = static_cast<std::uint8_t>(77 * i + 5);
  return bytes;
}

std::vector<TestEvent> small_drive() {
  std::vector<TestEvent> events;
  for (int i = 0; i < 24; ++i) {
    TestEvent event{.channel = {}, .time_us = kTestStart + 10'000 * i, .data = {}};
    switch (i % 6) {
      case 0:
      case 3:
        event.channel = "NAV_STATE";
        event.data = nav_state_bytes(0.1 * i);
        break;
      case 1:
        event.channel = "HEALTH";
        event.data = health_bytes(i % 4);
        break;
      case 2:
        event.channel = "IMU";
        event.data = encode(to_lcm(ImuSample{}));
        break;
      case 4:
        event.channel = "CAMERA_TRIGGER";
        event.data = unknown_bytes(40, static_cast<std::uint8_t>(i));
        break;
      default:
        event.channel = "X";
        event.data = i == 5 ? std::vector<std::uint8_t>{} : encode(to_lcm(RelativeMotion{}));
    }
    events.push_back(std::move(event));
  }
  return events;
}

void record(const std::filesystem::path& file, const std::vector<TestEvent>& events) {
  vehicle::LogRecorder recorder(file.string());
  for (const TestEvent& event : events) {
    recorder.send({event.channel, from_nanoseconds(event.time_us * 1000), event.data, true});
  }
  EXPECT_EQ(recorder.health().unsent, 0U);
}

std::vector<TestEvent> read_with_lcm(const std::filesystem::path& file) {
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

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  EXPECT_TRUE(in) << file;
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes) {
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  out.close();
  EXPECT_TRUE(out) << file;
}

void write_compressed(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes) {
  const gzFile out = gzopen(file.c_str(), "wb");
  EXPECT_EQ(gzwrite(out, bytes.data(), static_cast<unsigned>(bytes.size())),
            static_cast<int>(bytes.size()));
  EXPECT_EQ(gzclose(out), Z_OK);
}

std::vector<std::size_t> event_offsets(const std::vector<TestEvent>& events) {
  std::vector<std::size_t> offsets{0};
  for (const TestEvent& event : events) {
    offsets.push_back(offsets.back() + 28 + event.channel.size() + event.data.size());
  }
  return offsets;
}

}  // namespace maploop::lcm_log
