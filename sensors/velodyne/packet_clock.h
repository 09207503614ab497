// This file maps the firing times of Velodyne packets to the host's clock.
#pragma once

#include <cstdint>
#include <optional>

#include "msgs/time.h"
#include "sensors/clock/clock_offset.h"
#include "sensors/velodyne/position_packet.h"

namespace maploop::sensors {

struct PacketTime {
  Time first_firing{};
  std::uint64_t lost = 0;  // packets missing between the previous one and this one
  bool late = false;       // it was sent before the previous one and gets no time
};

// Extends the scanner's microseconds of the hour over hours, and maps them to the host's clock
// (ClockOffset). A scanner without such a clock (HDL-64E of the first series) is detected: its
// packets are stamped from their arrival. One thread at a time; does not allocate.
class PacketClock {
 public:
  // `period` is the time from one packet to the next; each is sent when it is full.
  PacketTime stamp(std::uint32_t device_time, Duration period, Time arrival);
  void add(const PositionPacket& packet);

  // Returns whether stamps come from the scanner's clock rather than from arrivals.
  bool has_device_time() const { return trust_ >= trusted; }
  std::uint64_t jumps() const { return jumps_; }
  const ClockOffset& offset() const { return offset_; }
  // UTC of the scanner's GPS receiver minus the host's clock; nothing until it is known.
  std::optional<Duration> gps_offset() const { return gps_offset_; }

 private:
  static constexpr int trusted = 8;  // number of packets whose clock advanced as expected

  void judge(Duration step, Duration arrival_step);

  ClockOffset offset_;
  std::optional<std::uint32_t> last_;  // microseconds of the hour
  Time last_arrival_{};
  Duration device_{};  // of the last packet, continuous over hours
  int trust_ = 0;      // 0 .. 2 * trusted
  std::uint64_t jumps_ = 0;
  std::optional<Duration> gps_offset_;
};

}  // namespace maploop::sensors
