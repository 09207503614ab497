// The data's time on this machine: when a stamp falls due.
#pragma once

#include <array>
#include <atomic>
#include <stop_token>

#include "msgs/time.h"

namespace maploop::runtime {

MonotonicTime monotonic_now();

// Paced: data time t is due at start + (t - first) / speed on the steady clock, later by the stalls
// and pauses so far. Virtual: every t is due at once and nobody sleeps; what happens is then
// decided by the order of the data alone. Live: paced in real time, and never stalled: it waits for
// nobody.
//
// start(), and then set_speed(), skip_to(), arrive(), pause(), resume() and resume_until() are
// one controlling thread's; all else is for any thread and takes no lock.
class DataClock {
 public:
  // Throws std::invalid_argument unless speed is finite and above 0.
  static DataClock paced(double speed) { return DataClock(speed, true, false); }
  static DataClock virtual_time() { return DataClock(1.0, false, false); }
  static DataClock live() { return DataClock(1.0, true, true); }

  DataClock(const DataClock& other);  // of a clock that has not been started
  DataClock& operator=(const DataClock&) = delete;

  // Data time `first` is due `lead` from now, or at that moment. Before other threads use the
  // clock.
  void start(Time first, Duration lead = {}) { start(first, monotonic_now() + lead); }
  void start(Time first, MonotonicTime due);

  bool is_paced() const { return paced_; }
  // Whether those that find an input missing go on without it.
  bool is_live() const { return live_; }
  // Whether t falls due at a moment of its own: neither in virtual time nor skipped over.
  bool keeps_time(Time t) const { return paced_ && !skipping(t); }
  double speed() const { return schedule().speed; }

  // When t is due; in virtual time, and for what is skipped: now.
  MonotonicTime due(Time t) const;

  // The data time that is due now; only in paced time.
  Time now() const;

  // Sleeps until t is due and not beyond a pause (virtual time: only the latter). False when
  // stopped before.
  bool sleep_until(Time t, const std::stop_token& stop) const;

  // Says that data time t could not be dealt with before `when`, because its input was not there:
  // when that is more than `tolerance` after it was due, everything from now on becomes due later
  // by as much. Returns whether the clock was stalled.
  bool stall(Time t, MonotonicTime when);
  static constexpr Duration tolerance = std::chrono::milliseconds(1);

  Duration stalled() const { return Duration(stalled_.load(std::memory_order_relaxed)); }
  std::uint64_t stalls() const { return stalls_.load(std::memory_order_relaxed); }

  // From now on at another speed. Throws as paced().
  void set_speed(double speed);

  // Everything up to t is due at once, and nothing after it: however long the way there takes, it
  // is not passed. Does nothing in virtual time.
  void skip_to(Time t);
  // The graph has come to where it was to skip to: that moment is now, and the clock paused there.
  void arrive(Time t);

  // Nothing after this moment falls due before resume() or resume_until(); only in paced time.
  void pause();
  void resume() { resume_until(Time::max()); }
  // From a pause to the next at t: not by way of a running clock, which would run past t when the
  // controlling thread is held up.
  void resume_until(Time t);
  // Reached its pause. A stall noticed late can take the clock back before it for a moment.
  bool paused() const;
  // There is one, reached or not.
  bool pause_set() const;

 private:
  // t is due at wall + (t - data) / speed, and later by the stalls since.
  struct Schedule {
    Time data;
    MonotonicTime wall;
    double speed;
  };

  DataClock(double speed, bool paced, bool live);
  bool skipping(Time t) const {
    return to_nanoseconds(t) < skip_to_.load(std::memory_order_acquire);
  }
  Schedule schedule() const;
  void set_schedule(const Schedule& schedule);
  MonotonicTime scheduled(Time t) const;  // without the stalls

  bool paced_;
  bool live_;
  // The last schedules, written by one thread. A reader takes the newest that is complete: it never
  // waits for a writer, which may have a lower priority and be held up in the middle.
  struct Slot {
    std::atomic<std::int64_t> data{0};
    std::atomic<std::int64_t> wall{0};
    std::atomic<double> speed{1.0};
  };
  static constexpr std::uint32_t slots = 4;
  std::array<Slot, slots> slots_;
  std::atomic<std::uint32_t> newest_{0};  // its slot is the remainder

  std::atomic<std::int64_t> skip_to_{to_nanoseconds(Time::min())};
  std::atomic<std::int64_t> pause_at_{to_nanoseconds(Time::max())};
  std::atomic<Duration::rep> stalled_{0};
  std::atomic<std::uint64_t> stalls_{0};
};

}  // namespace maploop::runtime
