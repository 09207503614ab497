// NCOM, the output of OXTS inertial units (RT3003 and its kin).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "msgs/imu.h"
#include "sensors/clock/clock_offset.h"

namespace maploop::sensors {

constexpr std::size_t ncom_size = 72;  // bytes

// A packet of structure A, its first batch: what the inertial sensors measure.
struct NcomSample {
  std::uint16_t minute_ms = 0;          // since the minute of GPS time began
  double specific_force_forward = 0.0;  // m/s^2
  double specific_force_left = 0.0;     // m/s^2
  double yaw_rate = 0.0;                // rad/s, positive when turning left
};

enum class NcomFault : std::uint8_t {
  none,
  wrong_size,
  no_sync,
  wrong_checksum,
  not_inertial,  // sound, but of structure B, or the unit's sensors are not running yet
  out_of_range
};
constexpr std::size_t ncom_fault_count = 6;

// NCOM's axes are forward, right, down. `bytes` is one packet; OXTS "NCOM data packet" manual,
// section 1 (all three checksums are checked).
std::optional<NcomSample> parse_ncom(std::span<const std::uint8_t> bytes, NcomFault& fault);

// Keeps the milliseconds of the minute going, on the host's clock. One thread at a time.
class NcomClock {
 public:
  // When a sample was taken that has arrived then; nothing where it is not later than the one
  // before.
  std::optional<Time> stamp(std::uint16_t minute_ms, Time arrival);

  const ClockOffset& offset() const { return offset_; }
  std::uint64_t jumps() const { return jumps_; }

 private:
  ClockOffset offset_;
  std::optional<std::uint16_t> last_;
  Duration device_{};
  Time last_arrival_{};
  Time last_stamp_ = Time::min();
  std::uint64_t jumps_ = 0;
};

}  // namespace maploop::sensors
