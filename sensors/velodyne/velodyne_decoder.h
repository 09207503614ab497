// This file makes scans from the packets of a Velodyne scanner, from the network or a capture.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "msgs/lidar_scan.h"
#include "sensors/velodyne/packet_clock.h"
#include "sensors/velodyne/packet_decoder.h"
#include "sensors/velodyne/turn_assembler.h"

namespace maploop::sensors {

struct VelodyneCounts {
  std::uint64_t data = 0;                                   // packets decoded
  std::uint64_t positions = 0;                              // packets of the GPS receiver
  std::array<std::uint64_t, packet_fault_count> refused{};  // by PacketFault
  std::uint64_t lost = 0;                                   // missing between others
  std::uint64_t late = 0;                                   // came after a later one; dropped
};

// A scan is one turn, from the rear to the rear, on the host's clock: `available` is the arrival of
// the packet that ended it, or the end of the turn if the clocks put that later. One thread at a
// time; allocates nothing but the buffers of a scan that is passed empty.
class VelodyneDecoder {
 public:
  VelodyneDecoder(VelodyneModel model, std::vector<Laser> lasers,
                  Duration max_turn = std::chrono::milliseconds(250));

  // Takes a UDP payload and its arrival; arrivals must not decrease. Returns true if it ended a
  // turn, which is then in `scan`, in exchange for its buffers; a packet ends at most one.
  bool add(std::span<const std::uint8_t> payload, Time arrival, LidarScan& scan);

  const VelodyneCounts& counts() const { return counts_; }
  std::uint64_t points() const { return points_; }  // of all packets, including incomplete turns
  const TurnCounts& turns() const { return assembler_.counts(); }
  const PacketClock& clock() const { return clock_; }

 private:
  VelodyneModel model_;
  PacketDecoder decoder_;
  PacketClock clock_;
  TurnAssembler assembler_;
  VelodyneCounts counts_;
  std::uint64_t points_ = 0;
  Time last_{};  // first firing of the previous packet
};

}  // namespace maploop::sensors
