#include "runtime/core/data_clock.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace maploop::runtime {
namespace {

// Longest sleep without a look at the stop token and at new stalls.
constexpr Duration longest_sleep = std::chrono::milliseconds(50);

void sleep_until_monotonic(MonotonicTime t) {
  const auto ns = t.time_since_epoch().count();
  const timespec target{ns / 1'000'000'000, ns % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &target, nullptr);
}

}  // namespace

MonotonicTime monotonic_now() {
  return std::chrono::time_point_cast<Duration>(std::chrono::steady_clock::now());
}

DataClock::DataClock(double speed, bool paced) : speed_(speed), paced_(paced) {
  if (!(std::isfinite(speed) && speed > 0.0)) {
    throw std::invalid_argument("the replay speed must be above 0, not " + std::to_string(speed));
  }
}

void DataClock::start(Time first, Duration lead) {
  first_ = first;
  start_ = monotonic_now() + lead;
}

MonotonicTime DataClock::scheduled(Time t) const {
  return start_ + Duration(std::llround(static_cast<double>((t - first_).count()) / speed_));
}

MonotonicTime DataClock::due(Time t) const {
  return paced_ ? scheduled(t) + stalled() : monotonic_now();
}

Time DataClock::now() const {
  const Duration passed = monotonic_now() - start_ - stalled();
  return first_ + Duration(std::llround(static_cast<double>(passed.count()) * speed_));
}

bool DataClock::sleep_until(Time t, const std::stop_token& stop) const {
  while (paced_ && !stop.stop_requested()) {
    const MonotonicTime target = due(t);
    const MonotonicTime now = monotonic_now();
    if (now >= target) break;
    sleep_until_monotonic(std::min(target, now + longest_sleep));
  }
  return !stop.stop_requested();
}

bool DataClock::stall(Time t, MonotonicTime when) {
  if (!paced_) return false;
  const Duration::rep needed = (when - scheduled(t)).count();
  Duration::rep current = stalled_.load(std::memory_order_relaxed);
  while (needed > current + tolerance.count()) {
    if (stalled_.compare_exchange_weak(current, needed, std::memory_order_relaxed)) {
      stalls_.fetch_add(1, std::memory_order_relaxed);
      return true;
    }
  }
  return false;
}

}  // namespace maploop::runtime
