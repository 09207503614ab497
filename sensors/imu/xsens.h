// Samples of an Xsens MTi (MTData2, "MT Low-Level Communication Protocol Documentation").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "msgs/time.h"

namespace maploop::sensors {

// In the unit's axes: x forward, y left, z up.
struct XsensSample {
  Duration time{};                         // of its own clock, to 0.1 ms; from anywhere
  std::array<double, 3> specific_force{};  // m/s^2
  std::array<double, 3> rate{};            // rad/s
};

struct XsensCounts {
  std::uint64_t messages = 0;    // sound ones
  std::uint64_t damaged = 0;     // begins of messages with a wrong checksum, or too long
  std::uint64_t incomplete = 0;  // MTData2 without sound acceleration, rate of turn, SampleTimeFine
};

// The unit is to send these three (in any precision). Memory is fixed. One thread at a time.
class XsensDecoder {
 public:
  // Bytes are taken off `bytes` until a sample is whole; false when all are taken.
  bool next(std::span<const std::uint8_t>& bytes, XsensSample& sample);
  // What comes next does not go on from what came.
  void restart() { size_ = 0; }

  const XsensCounts& counts() const { return counts_; }

 private:
  static constexpr std::size_t longest = 512;  // bytes of a message; these have 60

  bool take_message(XsensSample& sample);
  void drop(std::size_t count);
  std::optional<XsensSample> decode(std::span<const std::uint8_t> data);

  std::array<std::uint8_t, longest> message_{};
  std::size_t size_ = 0;
  std::optional<std::uint32_t> last_ticks_;
  std::int64_t ticks_ = 0;  // of 0.1 ms, which do not begin anew
  XsensCounts counts_;
};

}  // namespace maploop::sensors
