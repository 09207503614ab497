// The points of a data packet, each with its azimuth and time.
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
  double azimuth;   // hundredths of a degree that the scanner was turned to, 0 to 36000
  Duration offset;  // after the first firing of the packet
};

// Returns that came from nowhere (range 0), and the second of two equal ones, are left out. The
// azimuth of a laser is interpolated to its own moment: the scanner turns by 0.1 deg and more while
// it fires its lasers one after the other. Of the HDL-64E, whose order of firing within a block is
// not published, all lasers of a block have the block's. One thread at a time; allocates nothing.
class PacketDecoder {
 public:
  // Precondition: as many lasers as the model has.
  PacketDecoder(VelodyneModel model, std::vector<Laser> lasers);

  // Calls take(FiredPoint) for each point, in the order of their times.
  template <class Take>
  void decode(const DataPacket& packet, Take&& take) {
    begin(packet);
    // Of dual returns the two blocks of a firing belong together, laser by laser.
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

  // From this packet to the next.
  Duration period(const DataPacket& packet) const;

 private:
  bool is_dual(const DataPacket& packet) const;
  void begin(const DataPacket& packet);
  FiredPoint place(const DataPacket& packet, std::size_t block, std::size_t i,
                   VelodyneReturn found) const;
  Duration block_time(std::size_t block) const;

  VelodyneModel model_;
  std::vector<Laser> lasers_;
  std::vector<float> sines_;        // of each hundredth of a degree, a quarter more than a turn
  std::vector<Duration> in_block_;  // when each return of a block is fired
  // Of the packet at hand.
  bool dual_ = false;
  std::array<double, velodyne_blocks> rate_{};  // hundredths of a degree / ns
};

}  // namespace maploop::sensors
