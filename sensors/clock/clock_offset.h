// This file maps a sensor's clock to the host's from the arrival times of its messages.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "msgs/diagnostics.h"
#include "msgs/time.h"

namespace maploop::sensors {

struct ClockOffsetParameters {
  Duration bucket = std::chrono::seconds(1);  // uses the least delayed message of each
  std::size_t drift_buckets = 8;              // with fewer buckets no drift is estimated
  double max_drift = 200e-6;  // 1; a quartz is accurate to 100 ppm, so two differ by twice that
  Duration jump = std::chrono::milliseconds(500);      // no message stays this late for longer ...
  Duration patience = std::chrono::seconds(1);         // ... than this, unless a clock jumped
  Duration reordered = std::chrono::milliseconds(50);  // no message overtakes another by this much
  Duration step = std::chrono::milliseconds(50);       // if messages are this much later, and ...
  Duration steady = std::chrono::milliseconds(10);     // ... constant within this in each of ...
  std::size_t step_buckets = 3;                        // ... this many, a clock was set back
};

// Every message is delayed by at least the minimum transmission time, and by more when the link or
// this machine is busy. The straight line under the delays of the last 32 s is therefore the offset
// of the clocks plus that minimum, and its slope is their drift (after Moon, Skelly, Towsley,
// "Estimation and removal of clock skew from network delay measurements", INFOCOM 1999). The
// minimum delay itself cannot be observed; a caller that knows it subtracts it from the arrival.
// The result depends only on what is added; does not allocate. One thread at a time.
class ClockOffset {
 public:
  explicit ClockOffset(const ClockOffsetParameters& parameters = {}) : parameters_(parameters) {}

  // Adds a message with the sensor's time `device` (any origin, increasing). Returns true if one of
  // the clocks has jumped: earlier data are discarded, and this message is the first of a new
  // estimate. A clock that is set ahead by more than `jump` is detected at once; a smaller step is
  // absorbed by one message. A clock that is set back is detected at once if the message times go
  // back with it, and otherwise after `step_buckets` buckets.
  bool add(Duration device, Time arrival);

  // Discards all data, as after a jump.
  void forget() {
    count_ = 0;
    ++jumps_;
  }

  bool known() const { return count_ > 0; }
  // Precondition: known().
  Time to_host(Duration device) const;

  // Rate of the host's clock relative to the sensor's, minus 1; 0 until it can be estimated.
  double drift() const { return slope_; }
  // Delay of the last message relative to the line.
  Duration delay() const { return delay_; }

  // Returns these for a report; `utc_ahead` is the sensor's UTC minus the host's clock, if known.
  SensorClock state(std::optional<Duration> utc_ahead = {}) const {
    return {known(), utc_ahead, drift(), delay(), jumps_};
  }

 private:
  struct Point {
    Duration device{};
    Duration offset{};  // host - device
  };
  static constexpr std::size_t max_buckets = 32;

  void restart(Point point);
  void fit();
  bool set_back(Duration late);
  Duration line_at(Duration device) const;
  const Point& point(std::size_t i) const { return points_[(first_ + i) % max_buckets]; }
  Point& point(std::size_t i) { return points_[(first_ + i) % max_buckets]; }

  ClockOffsetParameters parameters_;
  std::array<Point, max_buckets> points_{};  // the lowest point of each bucket, ordered by time
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  Duration bucket_began_{};
  Duration newest_{};             // newest time of the sensor
  std::size_t late_buckets_ = 0;  // number in a row that are late by late_by_
  Duration late_by_{};
  Point anchor_{};  // a point on the line
  double slope_ = 0.0;
  Duration delay_{};
  Time late_since_{};
  bool late_ = false;
  std::uint64_t jumps_ = 0;
};

}  // namespace maploop::sensors
