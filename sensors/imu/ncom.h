// This file parses NCOM, the output of OXTS inertial units (RT3003 and similar).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "msgs/imu.h"
#include "sensors/clock/clock_offset.h"

namespace maploop::sensors {

constexpr std::size_t ncom_size = 72;  // bytes

// This is the first batch of a packet of structure A: what the inertial sensors measure.
struct NcomSample {
  std::uint16_t minute_ms = 0;  // ms since the start of the minute of GPS time
  InertialValues values;
};

enum class NcomFault : std::uint8_t {
  none,
  wrong_size,
  no_sync,
  wrong_checksum,
  not_inertial,  // valid, but of structure B, or the unit's sensors are not running yet
  out_of_range
};
constexpr std::size_t ncom_fault_count = 6;

// Parses one packet and checks all three checksums; NCOM's own axes are forward, right, down.
// Source: OXTS "NCOM data packet" manual, section 1. Returns nothing, and the reason in `fault`, if
// the packet cannot be used.
std::optional<NcomSample> parse_ncom(std::span<const std::uint8_t> bytes, NcomFault& fault);

// Extends the milliseconds of the minute to a continuous time on the host's clock. One thread at a
// time.
class NcomClock {
 public:
  // Returns when a sample was taken that arrived at `arrival`, or nothing if that is not later than
  // the previous one.
  std::optional<Time> stamp(std::uint16_t minute_ms, Time arrival);

  const ClockOffset& offset() const { return offset_; }

 private:
  ClockOffset offset_;
  std::optional<std::uint16_t> last_;
  Duration device_{};
  Time last_arrival_{};
  Time last_stamp_ = Time::min();
};

}  // namespace maploop::sensors
