// Scans out of the packets of a Velodyne scanner, whether they come from the network or a capture.
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
  std::uint64_t lost = 0;                                   // missing between those that came
  std::uint64_t late = 0;                                   // came after a later one, and left out
};

// One turn a scan, from the rear to the rear, on the host's clock: `available` is the arrival of
// the packet that ended it, or the end of the turn where the clocks put that later. One thread at a
// time; allocates nothing but the buffers of a scan that it is given empty.
class VelodyneDecoder {
 public:
  VelodyneDecoder(VelodyneModel model, std::vector<Laser> lasers,
                  Duration max_turn = std::chrono::milliseconds(250));

  // A UDP payload and when it arrived: times do not decrease. True when it ended a turn, which is
  // then in `scan`, in exchange for its buffers; at most one a packet.
  bool add(std::span<const std::uint8_t> payload, Time arrival, LidarScan& scan);

  const VelodyneCounts& counts() const { return counts_; }
  std::uint64_t points() const { return points_; }  // of all packets, whole turns or not
  const TurnCounts& turns() const { return assembler_.counts(); }
  const PacketClock& clock() const { return clock_; }

 private:
  VelodyneModel model_;
  PacketDecoder decoder_;
  PacketClock clock_;
  TurnAssembler assembler_;
  VelodyneCounts counts_;
  std::uint64_t points_ = 0;
  Time last_{};  // first firing of the packet before
};

}  // namespace maploop::sensors
