// Small logs for the tests of the log tools: written by the vehicle's recorder, read back by LCM
// itself.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "msgs/time.h"

namespace maploop::lcm_log {

struct TestEvent {
  std::string channel;
  std::int64_t time_us = 0;
  std::vector<std::uint8_t> data;

  bool operator==(const TestEvent&) const = default;
};

// 2011-09-26 13:10:51
inline constexpr std::int64_t kTestStart = 1'317'042'651'000'000;

// Returns 24 messages of five types (fixed and variable size; one type unknown), 10 ms apart.
std::vector<TestEvent> small_drive();

// Return one message each: NAV_STATE with its position east, HEALTH with `threads` threads, and one
// of an unknown type.
std::vector<std::uint8_t> nav_state_bytes(double east);
std::vector<std::uint8_t> health_bytes(int threads);
std::vector<std::uint8_t> unknown_bytes(std::size_t size, std::uint8_t seed);

// Writes with the vehicle's LogRecorder.
void record(const std::filesystem::path& file, const std::vector<TestEvent>& events);

// Reads with LCM's own reader.
std::vector<TestEvent> read_with_lcm(const std::filesystem::path& file);

std::vector<std::uint8_t> read_bytes(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes);
void write_compressed(const std::filesystem::path& file, const std::vector<std::uint8_t>& bytes);

// Returns the offset of each event of an undamaged log, and the end of the log.
std::vector<std::size_t> event_offsets(const std::vector<TestEvent>& events);

}  // namespace maploop::lcm_log
