// Small logs for the tests of the log tools: written by the vehicle's recorder, read back by LCM
// itself.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "msgs/lcm/checked_decode.h"
#include "tests/support/real_data.h"

namespace maploop::lcm_log {

using std::filesystem::path;

struct TestEvent {
  std::string channel;
  std::int64_t time_us = 0;
  std::vector<std::uint8_t> data;

  bool operator==(const TestEvent&) const = default;
};

// 2011-09-26 13:10:51
inline constexpr std::int64_t test_start = 1'317'042'651'000'000;

// Returns 24 messages of five types (fixed and variable size; one type unknown), 10 ms apart.
std::vector<TestEvent> small_drive();

// Return one message each: NAV_STATE with its position east, MAP_MATCH on a road "Main Street, way
// 7" to the north that bends to the right, 3 m east of the state, HEALTH with `threads` threads,
// and one of an unknown type.
std::vector<std::uint8_t> nav_state_bytes(double east);
std::vector<std::uint8_t> map_match_bytes();
std::vector<std::uint8_t> health_bytes(int threads);
std::vector<std::uint8_t> unknown_bytes(std::size_t size, std::uint8_t seed);

// Writes with the vehicle's LogRecorder.
void record(const path& file, const std::vector<TestEvent>& events);

// Reads with LCM's own reader.
std::vector<TestEvent> read_with_lcm(const path& file);

std::vector<std::uint8_t> read_bytes(const path& file);
void write_bytes(const path& file, const std::vector<std::uint8_t>& bytes);
void write_compressed(const path& file, const std::vector<std::uint8_t>& bytes);

// Returns the offset of each event of an undamaged log, and the end of the log.
std::vector<std::size_t> event_offsets(const std::vector<TestEvent>& events);

template <class Error, class F>
std::string error_of(const F& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Provides the small drive as a log in a separate folder.
class LogToolsTest : public ::testing::Test {
 protected:
  LogToolsTest() { record(log_, drive_); }

  void damage(std::size_t offset, std::uint8_t mask) {
    auto bytes = read_bytes(log_);
    bytes[offset] ^= mask;
    write_bytes(log_, bytes);
  }

  // Returns the drive without events first..last.
  std::vector<TestEvent> without(std::size_t first, std::size_t last) const {
    auto events = drive_;
    events.erase(events.begin() + static_cast<std::ptrdiff_t>(first),
                 events.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    return events;
  }

  const schema::Schema& types_ = schema::own_schema();
  const maploop::testing::TemporaryFolder folder_;
  const path log_ = folder_.path() / "a.lcmlog";
  const path out_ = folder_.path() / "out.lcmlog";
  const std::vector<TestEvent> drive_ = small_drive();
  const std::vector<std::size_t> offsets_ = event_offsets(drive_);
};

}  // namespace maploop::lcm_log
