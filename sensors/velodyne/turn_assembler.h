// This file assembles the turns of a spinning LiDAR from its points.
#pragma once

#include <cstdint>
#include <optional>

#include "msgs/lidar_scan.h"
#include "sensors/velodyne/packet_decoder.h"

namespace maploop::sensors {

struct TurnCounts {
  std::uint64_t complete = 0;
  std::uint64_t begun_midway = 0;  // the first one, and one after a gap
  std::uint64_t broken = 0;        // by a gap of over a quarter turn, or too long
  std::uint64_t points = 0;        // of complete turns
  std::uint64_t no_room = 0;       // points beyond the capacity of a turn
};

// A turn goes from the rear (azimuth 180 deg) to the rear; its stamp is the moment at which the
// scanner faced forward. Memory for the largest turn is reserved at the start. One thread at a
// time.
class TurnAssembler {
 public:
  // A turn that lasts longer than `max_turn` is broken.
  explicit TurnAssembler(Duration max_turn);

  // Takes a point with `azimuth` in hundredths of a degree. If the point begins a new turn and the
  // previous one is complete, that turn is swapped into `done` (all but `available`); returns true
  // then.
  bool add(const FiredPoint& fired, Time time, LidarScan& done);

  // Ends the current turn; the next points do not continue it.
  void interrupt();

  const TurnCounts& counts() const { return counts_; }

 private:
  void begin_turn(Time start);
  bool close(Time end, LidarScan& done);
  Time crossing(double at, double angle, Time time) const;

  Duration max_turn_;
  LidarScan turn_;
  bool inside_ = false;      // inside a turn whose beginning was seen
  bool stamped_ = false;     // the scanner has faced forward
  bool follows_ = false;     // last_... belong to the previous point
  double last_angle_ = 0.0;  // since the rear, hundredths of a degree, above 36000 at the end
  Time last_time_{};
  std::uint64_t sequence_ = 0;
  TurnCounts counts_;
};

}  // namespace maploop::sensors
