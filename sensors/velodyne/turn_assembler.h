// Turns of a spinning LiDAR out of its points.
#pragma once

#include <cstdint>
#include <optional>

#include "msgs/lidar_scan.h"
#include "sensors/velodyne/packet_decoder.h"

namespace maploop::sensors {

struct TurnCounts {
  std::uint64_t complete = 0;
  std::uint64_t begun_midway = 0;  // the first one, and after a gap
  std::uint64_t broken = 0;        // by a gap longer than a quarter of a turn, or it took too long
  std::uint64_t points = 0;        // of complete ones
  std::uint64_t no_room = 0;       // points beyond what a turn may have
};

// A turn goes from the rear (azimuth 180 deg) to the rear; its stamp is when the scanner faced
// forward. Memory for the largest turn is taken at the start. One thread at a time.
class TurnAssembler {
 public:
  // `max_turn`: longer, it is broken.
  explicit TurnAssembler(Duration max_turn);

  // `azimuth` in hundredths of a degree. Where the point begins a new turn and the one before is
  // complete, that is swapped into `done` (all but `available`); true then.
  bool add(const FiredPoint& fired, Time time, LidarScan& done);

  // What comes next does not follow what came.
  void interrupt();

  const TurnCounts& counts() const { return counts_; }

 private:
  void begin_turn(Time start);
  bool close(Time end, LidarScan& done);
  Time crossing(double at, double angle, Time time) const;

  Duration max_turn_;
  LidarScan turn_;
  bool inside_ = false;      // of a turn that was seen to begin
  bool stamped_ = false;     // it faced forward
  bool follows_ = false;     // last_... are of the point before
  double last_angle_ = 0.0;  // since the rear, hundredths of a degree, beyond a turn at its end
  Time last_time_{};
  std::uint64_t sequence_ = 0;
  TurnCounts counts_;
};

}  // namespace maploop::sensors
