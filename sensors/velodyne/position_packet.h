// This file parses a Velodyne position packet: what the scanner receives from its GPS receiver.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "msgs/time.h"

namespace maploop::sensors {

constexpr std::size_t velodyne_position_size = 512;  // bytes of the UDP payload

struct PositionPacket {
  std::uint32_t device_time = 0;  // microseconds since the hour
  bool pulse_locked = false;      // the scanner's clock follows the receiver's pulse per second
  // UTC of the last pulse by the receiver's $GPRMC, if the sentence is marked valid.
  std::optional<Time> receiver_time;

  // Returns UTC of device_time: the moment nearest to receiver_time with these microseconds of the
  // hour. Returns nothing unless the scanner is locked and has a receiver_time.
  std::optional<Time> utc() const;
};

// Returns nothing if the size is not that of a position packet.
std::optional<PositionPacket> parse_position_packet(std::span<const std::uint8_t> bytes);

}  // namespace maploop::sensors
