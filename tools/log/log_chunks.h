// When a chunk of a log in another container ends.
#pragma once

#include <cstddef>
#include <cstdint>

namespace maploop::lcm_log {

// Returns whether an event is alone in its chunk, which those who read other channels skip.
constexpr bool is_alone(std::size_t event_bytes) {
  constexpr std::size_t large_event = std::size_t{1} << 16U;
  return event_bytes >= large_event;
}

// A chunk ends at a mebibyte, or a second of the events' time.
constexpr bool is_full(std::size_t chunk_bytes, std::uint64_t chunk_nanoseconds) {
  constexpr std::size_t most_bytes = std::size_t{1} << 20U;
  constexpr std::uint64_t longest = 1'000'000'000;
  return chunk_bytes >= most_bytes || chunk_nanoseconds >= longest;
}

}  // namespace maploop::lcm_log
