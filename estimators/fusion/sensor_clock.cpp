#include "estimators/fusion/sensor_clock.h"

#include <algorithm>

#include "estimators/fusion/stamp_guard.h"

namespace maploop::fusion {

Reason SensorClock::check(const Sample& sample) {
  if (!plausible_stamp(sample.available)) return Reason::none;
  const Duration age = sample.available - sample.stamp;
  const Duration last_age = last_available_ - last_stamp_;
  const bool first = last_stamp_ == Time{};
  if (fallen_) {
    if (age > believed_age_) return Reason::clock_fell_back;
    fallen_ = false;
  } else if (!first && sample.sequence > last_sequence_ && sample.stamp < last_stamp_ &&
             std::chrono::abs(age - usual_age_) > std::chrono::abs(last_age - usual_age_)) {
    fallen_ = true;
    believed_age_ = last_age / 2 + age / 2;
    return Reason::clock_fell_back;
  }
  if (first || sample.sequence > last_sequence_) follow(sample);
  return Reason::none;
}

// The usual age changes at most as fast as two clocks drift apart, so a step of one clock takes
// minutes to become usual.
void SensorClock::follow(const Sample& sample) {
  const Duration age = sample.available - sample.stamp;
  if (last_stamp_ == Time{}) {
    usual_age_ = age;
  } else {
    constexpr std::int64_t parts_of_drift = 5000;  // 200e-6
    const Duration most =
        std::chrono::abs(sample.available - last_available_) / parts_of_drift + Duration(1);
    usual_age_ += std::clamp(age - usual_age_, -most, most);
  }
  last_stamp_ = sample.stamp;
  last_available_ = sample.available;
  last_sequence_ = sample.sequence;
}

}  // namespace maploop::fusion
