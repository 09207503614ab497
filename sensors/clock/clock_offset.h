// From a sensor's clock to the host's, by when its messages arrive.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "msgs/time.h"

namespace maploop::sensors {

struct ClockOffsetParameters {
  Duration bucket = std::chrono::seconds(1);  // of each, the least delayed message counts
  std::size_t drift_buckets = 8;              // fewer do not show a drift
  double max_drift = 200e-6;  // 1; quartz is within 100 ppm of the truth, twice that of another
  Duration jump = std::chrono::milliseconds(500);      // no message is so late for long ...
  Duration patience = std::chrono::seconds(1);         // ... and longer than this
  Duration reordered = std::chrono::milliseconds(50);  // no message overtakes by so much
  Duration step = std::chrono::milliseconds(50);       // a way that is so much longer, and ...
  Duration steady = std::chrono::milliseconds(10);     // ... that much the same in each of ...
  std::size_t step_buckets = 3;                        // ... so many in a row, is a clock set back
};

// Messages are delayed by at least what the way takes, and by more when the way or this machine is
// busy: the straight line under the delays of the last 32 s is the offset of the clocks with that
// least delay, and its slope their drift (after Moon, Skelly, Towsley, "Estimation and removal of
// clock skew from network delay measurements", INFOCOM 1999). The least delay itself cannot be
// seen; whoever knows it takes it off the arrival. Depends on what is added alone; allocates
// nothing. One thread at a time.
class ClockOffset {
 public:
  explicit ClockOffset(const ClockOffsetParameters& parameters = {}) : parameters_(parameters) {}

  // A message of the sensor's time `device` (any origin, increasing) has arrived. True where one of
  // the clocks has jumped: what was known is forgotten, and this is the first message anew. A clock
  // that is set ahead by more than `jump` shows at once, and less than that needs no more than one
  // message; one that is set back shows at once where the messages go back with it, and after
  // `step_buckets` where they do not.
  bool add(Duration device, Time arrival);

  bool known() const { return count_ > 0; }
  // Precondition: known().
  Time to_host(Duration device) const;

  // How fast the host's clock runs beyond the sensor's, 1; 0 until it shows.
  double drift() const { return slope_; }
  // How much later than the line the last message came.
  Duration delay() const { return delay_; }

 private:
  struct Point {
    Duration device{};
    Duration offset{};  // host - device
  };
  static constexpr std::size_t most_buckets = 32;

  void restart(Point point);
  void fit();
  bool set_back(Duration late);
  Duration line_at(Duration device) const;
  const Point& point(std::size_t i) const { return points_[(first_ + i) % most_buckets]; }
  Point& point(std::size_t i) { return points_[(first_ + i) % most_buckets]; }

  ClockOffsetParameters parameters_;
  std::array<Point, most_buckets> points_{};  // the lowest of each bucket, in the order of time
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  Duration bucket_began_{};
  Duration newest_{};             // of the sensor's times
  std::size_t late_buckets_ = 0;  // in a row, by late_by_
  Duration late_by_{};
  Point anchor_{};  // the line goes through it
  double slope_ = 0.0;
  Duration delay_{};
  Time late_since_{};
  bool late_ = false;
};

}  // namespace maploop::sensors
