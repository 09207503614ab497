// Measures how one thread keeps its time: latency, wake-up, execution, and the jitter of its
// period.
//
// Co-ordinated omission (Tene) means that a stall hides the waits of what would have come
// meanwhile.
// - Ticks that catch up are each recorded with their own lateness. Nothing is hidden, and adding
//   anything would count them twice.
// - When the data clock is stalled, everything after it becomes due later: the ticks that would
//   have been late by then are on time. Their waits are the latency's `omitted`, as HdrHistogram's
//   recordWithExpectedInterval computes them for the length of the stall.
// - A tick that is left out (Overrun::skip) would have waited as well, and is treated likewise.
// Only the latency of a fixed-rate thread has `omitted` waits. Wake-up, execution, jitter and paths
// are as recorded, and so are threads released by samples: each sample waits in the ring and is
// recorded when its turn comes. These do not show how long a stall of the data clock, which HEALTH
// counts, delays the samples after it.
#pragma once

#include <atomic>
#include <cstdint>

#include "runtime/core/data_clock.h"
#include "runtime/core/periodic.h"
#include "runtime/vehicle/graph/stage_specs.h"
#include "runtime/vehicle/health/meter.h"

namespace maploop::vehicle {

// Only the thread that is measured records, without a lock, an allocation or a system call. One
// other thread at a time may read the summaries, also while the first one records.
class ThreadMeter {
 public:
  explicit ThreadMeter(const StageSpec& stage);

  // A fixed-rate thread calls this at the beginning of each tick, while the clock keeps time.
  void woke(const runtime::Tick& tick, const runtime::DataClock& clock, MonotonicTime due,
            MonotonicTime woken);

  // Work is one sample that a thread released by samples has processed.
  struct Work {
    Time stamp{};
    MonotonicTime released{}, started{}, ended{};
    const char* busy_before = "";  // what the sample waited for: a string literal
  };
  // `timed` is whether the clock keeps time. Returns whether the deadline was missed.
  bool worked(const Work& work, bool timed);

  // Any other thread records how long it was ready before it ran; a driver, how long its sample was
  // due.
  void woke(Duration late) { wake_up_.record(late); }

  // Records how long one tick, sample or message took: from beginning to end, but the processor
  // time of a driver, which waits within its steps.
  void ran(Duration execution) { execution_.record(execution); }

  Meter& latency() { return latency_; }
  const Meter& latency() const { return latency_; }

  bool has_deadline() const { return has_deadline_; }  // if not, latency() is empty
  std::uint64_t count() const { return execution_.count(); }
  std::uint64_t left_out() const { return left_out_.load(std::memory_order_relaxed); }

  const runtime::Histogram& wake_up() const { return wake_up_; }
  const runtime::Histogram& execution() const { return execution_; }
  const runtime::Histogram& period_jitter() const { return period_jitter_; }

 private:
  Duration period_;
  bool has_deadline_;
  Meter latency_;
  runtime::Histogram wake_up_;
  runtime::Histogram execution_;
  runtime::Histogram period_jitter_;
  std::atomic<std::uint64_t> left_out_{0};
  MonotonicTime last_due_{};
  MonotonicTime last_woken_{};
  Duration stalled_{};          // the data clock's stalls at the last tick
  MonotonicTime idle_since_{};  // end of the last work
};

}  // namespace maploop::vehicle
