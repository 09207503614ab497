// The data's time on this machine: when a stamp falls due.
#pragma once

#include <atomic>
#include <stop_token>

#include "msgs/time.h"

namespace maploop::runtime {

MonotonicTime monotonic_now();

// Paced: data time t is due at start + (t - first) / speed on the steady clock, later by the stalls
// so far. Virtual: every t is due at once and nobody sleeps; what happens is then decided by the
// order of the data alone. All members but start() may be called from any thread.
class DataClock {
 public:
  // Throws std::invalid_argument unless speed is finite and above 0.
  static DataClock paced(double speed) { return DataClock(speed, true); }
  static DataClock virtual_time() { return DataClock(1.0, false); }

  DataClock(const DataClock& other)
      : speed_(other.speed_), paced_(other.paced_), first_(other.first_), start_(other.start_) {}
  DataClock& operator=(const DataClock&) = delete;

  // Data time `first` is due `lead` from now. Call once, before other threads use the clock.
  void start(Time first, Duration lead = {});

  bool is_paced() const { return paced_; }
  double speed() const { return speed_; }

  // When t is due; in virtual time: now.
  MonotonicTime due(Time t) const;

  // The data time that is due now; only in paced time.
  Time now() const;

  // Sleeps until t is due (at once in virtual time). False when stopped before.
  bool sleep_until(Time t, const std::stop_token& stop) const;

  // Says that data time t could not be dealt with before `when`, because its input was not there:
  // when that is more than `tolerance` after it was due, everything from now on becomes due later
  // by as much. Returns whether the clock was stalled.
  bool stall(Time t, MonotonicTime when);
  static constexpr Duration tolerance = std::chrono::milliseconds(1);

  Duration stalled() const { return Duration(stalled_.load(std::memory_order_relaxed)); }
  std::uint64_t stalls() const { return stalls_.load(std::memory_order_relaxed); }

 private:
  DataClock(double speed, bool paced);
  MonotonicTime scheduled(Time t) const;  // without the stalls

  double speed_;
  bool paced_;
  Time first_{};
  MonotonicTime start_{};
  std::atomic<Duration::rep> stalled_{0};
  std::atomic<std::uint64_t> stalls_{0};
};

}  // namespace maploop::runtime
