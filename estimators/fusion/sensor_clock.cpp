#include "estimators/fusion/sensor_clock.h"

#include "estimators/fusion/stamp_guard.h"

namespace maploop::fusion {

Reason SensorClock::check(const Sample& sample) {
  if (!plausible_stamp(sample.available)) return Reason::none;
  const Duration age = sample.available - sample.stamp;
  if (fallen_) {
    if (age > believed_age_) return Reason::clock_fell_back;
    fallen_ = false;
  } else if (last_stamp_ != Time{} && sample.sequence > last_sequence_ &&
             sample.stamp < last_stamp_) {
    fallen_ = true;
    believed_age_ = (last_available_ - last_stamp_) / 2 + age / 2;
    return Reason::clock_fell_back;
  }
  if (last_stamp_ == Time{} || sample.sequence > last_sequence_) {
    last_stamp_ = sample.stamp;
    last_available_ = sample.available;
    last_sequence_ = sample.sequence;
  }
  return Reason::none;
}

}  // namespace maploop::fusion
