#include "runtime/core/data_clock.h"

#include <ctime>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace maploop::runtime {
namespace {

// This is the longest sleep without a check of the stop token, new stalls and the schedule.
constexpr Duration longest_sleep = std::chrono::milliseconds(20);

void sleep_until_monotonic(MonotonicTime t) {
  const auto ns = t.time_since_epoch().count();
  const timespec target{ns / 1'000'000'000, ns % 1'000'000'000};
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &target, nullptr);
}

double checked_speed(double speed) {
  if (!(std::isfinite(speed) && speed > 0.0)) {
    throw std::invalid_argument("the replay speed must be above 0, not " + std::to_string(speed));
  }
  return speed;
}

Duration scaled(Duration d, double factor) {
  return Duration(std::llround(static_cast<double>(d.count()) * factor));
}

}  // namespace

MonotonicTime monotonic_now() {
  return std::chrono::time_point_cast<Duration>(std::chrono::steady_clock::now());
}

DataClock::DataClock(double speed, bool paced, bool live) : paced_(paced), live_(live) {
  slots_[0].speed = checked_speed(speed);
}

DataClock::DataClock(const DataClock& other)
    : DataClock(other.speed(), other.paced_, other.live_) {}

void DataClock::start(Time first, MonotonicTime due) {
  set_schedule({first, due, speed()});
}

// A slot may be overwritten once slots - 1 newer schedules are complete; a read during which that
// happened is repeated. Acquire and release on the data itself, after Boehm, "Can seqlocks get
// along with programming language memory models?" (MSPC 2012): a reader of a value of a newer
// schedule also sees the number of the schedule before it.
DataClock::Schedule DataClock::schedule() const {
  for (;;) {
    const std::uint32_t before = newest_.load(std::memory_order_acquire);
    const Slot& slot = slots_[before % slots];
    const Schedule s{from_nanoseconds(slot.data.load(std::memory_order_acquire)),
                     MonotonicTime(Duration(slot.wall.load(std::memory_order_acquire))),
                     slot.speed.load(std::memory_order_acquire)};
    if (newest_.load(std::memory_order_relaxed) - before < slots - 1) return s;
  }
}

void DataClock::set_schedule(const Schedule& s) {
  const std::uint32_t next = newest_.load(std::memory_order_relaxed) + 1;
  Slot& slot = slots_[next % slots];
  slot.data.store(to_nanoseconds(s.data), std::memory_order_release);
  slot.wall.store(s.wall.time_since_epoch().count(), std::memory_order_release);
  slot.speed.store(s.speed, std::memory_order_release);
  newest_.store(next, std::memory_order_release);
}

MonotonicTime DataClock::scheduled(Time t) const {
  const Schedule s = schedule();
  return s.wall + scaled(t - s.data, 1.0 / s.speed);
}

MonotonicTime DataClock::due(Time t) const {
  return keeps_time(t) ? scheduled(t) + stalled() : monotonic_now();
}

Time DataClock::running() const {
  const Schedule s = schedule();
  return s.data + scaled(monotonic_now() - s.wall - stalled(), s.speed);
}

Time DataClock::now() const {
  return std::min(running(), from_nanoseconds(pause_at_.load(std::memory_order_relaxed)));
}

bool DataClock::sleep_until(Time t, const std::stop_token& stop) const {
  while (!stop.stop_requested()) {
    const MonotonicTime target = due(t);
    const MonotonicTime now = monotonic_now();
    const bool held = to_nanoseconds(t) > pause_at_.load();  // after `now`: see pause()
    if (!held && now >= target) return true;
    sleep_until_monotonic(held ? now + longest_sleep : std::min(target, now + longest_sleep));
  }
  return false;
}

bool DataClock::stall(Time t, MonotonicTime when) {
  if (live_ || !keeps_time(t)) return false;
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

void DataClock::set_speed(double speed) {
  const Time position = now();
  set_schedule({position, monotonic_now() - stalled(), checked_speed(speed)});
}

void DataClock::skip_to(Time t) {
  if (!paced_) return;
  pause_at_.store(to_nanoseconds(t), std::memory_order_release);
  skip_to_.store(to_nanoseconds(t), std::memory_order_release);
}

void DataClock::arrive(Time t) {
  set_schedule({t, monotonic_now() - stalled(), speed()});
  skip_to_.store(to_nanoseconds(Time::min()), std::memory_order_release);
}

// The controlling thread may be preempted between reading the time and storing it, and samples are
// released meanwhile. The first store stops them: whoever has not seen it has read the time before
// it, and so releases nothing that is later than the second.
void DataClock::pause() {
  const Time last = from_nanoseconds(pause_at_.load(std::memory_order_relaxed));
  const Time held = now();
  pause_at_.store(to_nanoseconds(held));
  pause_at_.store(to_nanoseconds(std::min(last, std::max(held, running()))));
}

void DataClock::resume_until(Time t) {
  const Time position = now();
  set_schedule({position, monotonic_now() - stalled(), speed()});
  pause_at_.store(to_nanoseconds(std::max(t, position)), std::memory_order_release);
}

bool DataClock::pause_set() const {
  return pause_at_.load(std::memory_order_relaxed) != to_nanoseconds(Time::max());
}

bool DataClock::paused() const {
  return to_nanoseconds(now()) >= pause_at_.load(std::memory_order_relaxed);
}

}  // namespace maploop::runtime
