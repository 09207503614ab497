// Makes the scans of a LiDAR from clouds whose points have times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "msgs/lidar_scan.h"
#include "msgs/time.h"
#include "sensors/bag/cloud_messages.h"
#include "sensors/velodyne/turn_assembler.h"

namespace maploop::sensors {

// If the scanner turns clockwise, seen from above, turns from rear to rear (turn_assembler.h) are
// assembled, wherever its clouds begin. Of any other scanner each cloud is a scan, and its points
// keep their times. The first clouds show which one it is: they wait until a turn is complete, or
// until there is none in twice the longest turn. One thread at a time.
class CloudScans {
 public:
  // A turn that lasts longer than `max_turn` is none.
  explicit CloudScans(Duration max_turn) : max_turn_(max_turn), assembler_(max_turn) {}

  // Takes a cloud with times; its buffers are taken. Call next() until it returns false
  // before the next cloud.
  void add(TimedCloud& cloud);
  // No cloud follows. Returns whether next() has clouds that waited.
  bool end();
  // `stamp`, `available` and the rest are set.
  bool next(LidarScan& scan);

 private:
  enum class Scanner : std::uint8_t { not_known, turning, other };

  bool next_turn(LidarScan& scan);
  void make_scan(TimedCloud& cloud, LidarScan& scan);

  Duration max_turn_;
  Scanner scanner_ = Scanner::not_known;
  std::deque<TimedCloud> waiting_;
  Time first_{};  // of the first cloud

  TurnAssembler assembler_;
  TimedCloud cloud_;                  // whose points go to the assembler
  std::vector<std::uint32_t> order_;  // of its points, by time
  std::size_t at_ = 0;
  std::uint64_t sequence_ = 0;
};

}  // namespace maploop::sensors
