// This file computes the points of a data packet, each with its azimuth and time.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "msgs/lidar_scan.h"
#include "sensors/velodyne/data_packet.h"
#include "sensors/velodyne/lasers.h"

namespace maploop::sensors {

struct FiredPoint {
  LidarPoint point;
  double azimuth;   // hundredths of a degree to which the scanner was turned, 0 to 36000
  Duration offset;  // after the first firing of the packet
};

// Leaves out missing returns (range 0), and the second of two equal ones. The azimuth of each laser
// is interpolated to its own moment: the scanner turns by 0.1 deg and more while it fires its
// lasers one after the other. For the HDL-64E, whose order of firing within a block is not
// published, all lasers of a block have the block's azimuth. One thread at a time; does not
// allocate.
class PacketDecoder {
 public:
  // Precondition: `lasers` has laser_count(model) elements. Throws std::logic_error otherwise.
  PacketDecoder(VelodyneModel model, std::vector<Laser> lasers);

  // Calls take(FiredPoint) for each point, in the order of their times.
  template <class Take>
  void decode(const DataPacket& packet, Take&& take) {
    begin(packet);
    // With dual returns the two blocks of a firing are decoded together, laser by laser.
    const std::size_t together = dual_ ? 2 : 1;
    for (std::size_t block = 0; block < velodyne_blocks; block += together) {
      for (std::size_t i = 0; i < velodyne_block_returns; ++i) {
        const VelodyneReturn first = packet(block, i);
        if (first.range > 0) take(place(packet, block, i, first));
        if (!dual_) continue;
        const VelodyneReturn second = packet(block + 1, i);
        if (second.range > 0 && second.range != first.range) {
          take(place(packet, block, i, second));
        }
      }
    }
  }

  // Returns the time from this packet to the next.
  Duration period(const DataPacket& packet) const;

 private:
  bool is_dual(const DataPacket& packet) const;
  void begin(const DataPacket& packet);
  FiredPoint place(const DataPacket& packet, std::size_t block, std::size_t i,
                   VelodyneReturn found) const;
  Duration block_time(std::size_t block) const;

  VelodyneModel model_;
  std::vector<Laser> lasers_;
  std::vector<float> sines_;        // by hundredths of a degree, over one and a quarter turns
  std::vector<Duration> in_block_;  // firing time of each return within a block
  // These belong to the current packet.
  bool dual_ = false;
  std::array<double, velodyne_blocks> rate_{};  // hundredths of a degree / ns
};

}  // namespace maploop::sensors
