// This file maps data time to this machine's time: when a stamp falls due.
#pragma once

#include <array>
#include <atomic>
#include <stop_token>

#include "msgs/time.h"

namespace maploop::runtime {

MonotonicTime monotonic_now();

// Paced: data time t is due at start + (t - first) / speed on the steady clock, later by the stalls
// and pauses so far. Virtual: every t is due at once and no thread sleeps; the order of the data
// alone decides what happens. Live: paced in real time, and never stalled: it does not wait for
// data.
//
// One controlling thread calls start(), and then set_speed(), skip_to(), arrive(), pause(),
// resume() and resume_until(); any thread may call the other members, which take no lock.
class DataClock {
 public:
  // Throws std::invalid_argument unless speed is finite and above 0.
  static DataClock paced(double speed) { return DataClock(speed, true, false); }
  static DataClock virtual_time() { return DataClock(1.0, false, false); }
  static DataClock live() { return DataClock(1.0, true, true); }

  DataClock(const DataClock& other);  // only from a clock that has not been started
  DataClock& operator=(const DataClock&) = delete;

  // Makes data time `first` due `lead` from now, or at `due`. Call it before other threads use the
  // clock.
  void start(Time first, Duration lead = {}) { start(first, monotonic_now() + lead); }
  void start(Time first, MonotonicTime due);

  bool is_paced() const { return paced_; }
  // Returns whether stages continue without a missing input.
  bool is_live() const { return live_; }
  // Returns whether t falls due at its own moment: neither in virtual time nor skipped.
  bool keeps_time(Time t) const { return paced_ && !skipping(t); }
  double speed() const { return schedule().speed; }

  // Returns when t is due; now in virtual time, and for skipped times.
  MonotonicTime due(Time t) const;

  // Returns the data time that is due now; only in paced time.
  Time now() const;

  // Sleeps until t is due and not held back by a pause (in virtual time: only the latter). Returns
  // false if stopped before.
  bool sleep_until(Time t, const std::stop_token& stop) const;

  // Reports that data time t could not be processed before `when`, because its input was missing.
  // If that is more than `tolerance` after t was due, everything from now on becomes due later by
  // the same amount. Returns whether the clock was stalled.
  bool stall(Time t, MonotonicTime when);
  static constexpr Duration tolerance = std::chrono::milliseconds(1);

  Duration stalled() const { return Duration(stalled_.load(std::memory_order_relaxed)); }
  std::uint64_t stalls() const { return stalls_.load(std::memory_order_relaxed); }

  // Continues at another speed. Throws like paced().
  void set_speed(double speed);

  // Makes everything up to t due at once, and nothing after it, however long the skip takes. Has no
  // effect in virtual time.
  void skip_to(Time t);
  // Ends the skip when the graph has reached t: that moment is now, and the clock is paused there.
  void arrive(Time t);

  // Lets nothing after this moment fall due before resume() or resume_until(); only in paced time.
  void pause();
  void resume() { resume_until(Time::max()); }
  // Goes from a pause to the next one at t. The clock does not run in between, since it would run
  // past t if the controlling thread were delayed.
  void resume_until(Time t);
  // Returns whether the pause is reached. A stall noticed late can briefly set the clock back
  // before it.
  bool paused() const;
  // Returns whether a pause is set, reached or not.
  bool pause_set() const;

 private:
  // t is due at wall + (t - data) / speed, plus the stalls since then.
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
  Time running() const;                   // the data time that is due now, if no pause holds it

  bool paced_;
  bool live_;
  // These are the last schedules, written by one thread. A reader takes the newest complete one. It
  // never waits for the writer, which may have a lower priority and be preempted while it writes.
  struct Slot {
    std::atomic<std::int64_t> data{0};
    std::atomic<std::int64_t> wall{0};
    std::atomic<double> speed{1.0};
  };
  static constexpr std::uint32_t slots = 4;
  std::array<Slot, slots> slots_;
  std::atomic<std::uint32_t> newest_{0};  // its slot is the remainder modulo slots

  std::atomic<std::int64_t> skip_to_{to_nanoseconds(Time::min())};
  std::atomic<std::int64_t> pause_at_{to_nanoseconds(Time::max())};
  std::atomic<Duration::rep> stalled_{0};
  std::atomic<std::uint64_t> stalls_{0};
};

}  // namespace maploop::runtime
