// Moves the stamps of a recorded sensor to the moments of its measurements.
#pragma once

#include <memory>
#include <utility>

#include "msgs/time.h"
#include "sensors/source.h"

namespace maploop::sensors {

// Sets all times of a sample at which something was measured `delay` earlier. `available` is when
// the sensor delivers it, and stays.
template <class T>
void take_delay(T& sample, Duration delay) {
  sample.stamp -= delay;
  if constexpr (requires { sample.velocity_stamp; }) sample.velocity_stamp -= delay;
  if constexpr (requires { sample.from; }) sample.from -= delay;
  if constexpr (requires { sample.start; }) {
    sample.start -= delay;
    sample.end -= delay;
  }
}

// The source itself is returned if it is nullptr, or without a delay.
template <class T>
std::unique_ptr<Source<T>> delayed(std::unique_ptr<Source<T>> source, Duration delay) {
  if (source == nullptr || delay == Duration::zero()) return source;
  return derived(std::move(source), [delay](Source<T>& all, T& sample) {
    if (!all.next(sample)) return false;
    take_delay(sample, delay);
    return true;
  });
}

}  // namespace maploop::sensors
