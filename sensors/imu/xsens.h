// This file decodes samples of an Xsens MTi (MTData2, "MT Low-Level Communication Protocol
// Documentation").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "msgs/time.h"

namespace maploop::sensors {

// All values are in the unit's axes: x forward, y left, z up.
struct XsensSample {
  Duration time{};                         // of the unit's own clock, to 0.1 ms; any origin
  std::array<double, 3> specific_force{};  // m/s^2
  std::array<double, 3> rate{};            // rad/s
};

struct XsensCounts {
  std::uint64_t messages = 0;    // valid ones
  std::uint64_t damaged = 0;     // message starts with a wrong checksum, or too long
  std::uint64_t incomplete = 0;  // MTData2 that lacks a value that is needed
};

// The unit must send acceleration, rate of turn and SampleTimeFine (in any precision). Memory is
// fixed. One thread at a time.
class XsensDecoder {
 public:
  // Takes bytes off `bytes` until a sample is complete (true), or until all are taken (false).
  bool next(std::span<const std::uint8_t>& bytes, XsensSample& sample);
  // Discards the bytes taken so far; the next ones do not continue them.
  void restart() { size_ = 0; }

  const XsensCounts& counts() const { return counts_; }

 private:
  static constexpr std::size_t longest = 512;  // bytes of a message; the usual one has 60

  bool take_message(XsensSample& sample);
  void drop(std::size_t count);
  std::optional<XsensSample> decode(std::span<const std::uint8_t> data);

  std::array<std::uint8_t, longest> message_{};
  std::size_t size_ = 0;
  std::optional<std::uint32_t> last_ticks_;
  std::int64_t ticks_ = 0;  // 0.1 ms ticks, extended beyond 32 bits
  XsensCounts counts_;
};

}  // namespace maploop::sensors
