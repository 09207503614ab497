// Stamps the epochs of a GNSS receiver in the host's time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "msgs/diagnostics.h"
#include "msgs/sample.h"
#include "ppp/gps_time.h"
#include "sensors/clock/clock_offset.h"

namespace maploop::vehicle {

// EpochStamps is for one thread at a time.
class EpochStamps {
 public:
  // An epoch arrives at least `latency` after its time; this is taken off each arrival time.
  explicit EpochStamps(Duration latency) : latency_(latency) {}

  // Sets `stamp` and `available` of the sample in the host's time. Both strictly increase whatever
  // the clocks do, so that no two epochs have the same stamp.
  void stamp(ppp::GpsTime time, Time arrival, Sample& sample) {
    const Duration utc = ppp::to_utc(time).time_since_epoch();
    if (offset_.add(utc, arrival - latency_)) ++jumps_;
    const Time on_host = offset_.to_host(utc);
    utc_ahead_ = utc - on_host.time_since_epoch();
    sample.stamp = last_stamp_ = std::max(on_host, last_stamp_ + Duration(1));
    sample.available = last_available_ = std::max(arrival, last_available_ + Duration(1));
  }

  SensorClock clock() const {
    return {offset_.known(), utc_ahead_, offset_.drift(), offset_.delay(), jumps_};
  }

 private:
  Duration latency_;
  sensors::ClockOffset offset_;
  std::optional<Duration> utc_ahead_;
  std::uint64_t jumps_ = 0;
  Time last_stamp_{}, last_available_{};
};

}  // namespace maploop::vehicle
