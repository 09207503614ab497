// How one thread keeps its time: latency, wake-up, execution, and the jitter of its period.
//
// Co-ordinated omission (Tene): a stall hides the waits of those who would have come meanwhile.
// - Ticks that catch up are each recorded with their own lateness: nothing is hidden, and adding
//   anything would count them twice.
// - Where the data clock is stalled, everything behind becomes due later: the ticks that would have
//   been late by then are on time. Those waits are the latency's `omitted`, as HdrHistogram's
//   recordWithExpectedInterval has them for the length of the stall.
// - A tick that is left out (Overrun::skip) would have waited as well: likewise.
// Only the latency of a fixed-rate thread has `omitted` waits. Wake-up, execution and jitter,
// threads released by samples (each waits in the ring, and is recorded when its turn comes), and
// paths are as recorded; a stall of the data clock, counted on HEALTH, delays the samples behind it
// unseen.
#pragma once

#include <atomic>
#include <cstdint>

#include "runtime/core/data_clock.h"
#include "runtime/core/periodic.h"
#include "runtime/vehicle/graph.h"
#include "runtime/vehicle/meter.h"

namespace maploop::vehicle {

// One thread records, the one that is measured, without a lock, an allocation or a system call; one
// other thread at a time reads the summaries, also meanwhile.
class ThreadMeter {
 public:
  explicit ThreadMeter(const Stage& stage);

  // A fixed-rate thread at the beginning of each tick, while the clock keeps time.
  void woke(const runtime::Tick& tick, const runtime::DataClock& clock, MonotonicTime due,
            MonotonicTime woken);

  // A thread released by samples has dealt with one.
  struct Work {
    Time stamp{};
    MonotonicTime released{}, started{}, ended{};
    const char* busy_before = "";  // what it waited for: a string literal
  };
  // `timed`: while the clock keeps time. Whether the deadline was missed.
  bool worked(const Work& work, bool timed);

  // Any other thread: it could have run for so long.
  void woke(Duration late) { wake_up_.record(late); }

  // One tick, sample or message took so long.
  void ran(Duration execution) { execution_.record(execution); }

  Meter& latency() { return latency_; }
  const Meter& latency() const { return latency_; }

  bool has_deadline() const { return has_deadline_; }  // else nothing is recorded in latency()
  std::uint64_t count() const { return execution_.count(); }
  std::uint64_t left_out() const { return left_out_.load(std::memory_order_relaxed); }
  std::uint64_t shed() const { return shed_.load(std::memory_order_relaxed); }

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
  std::atomic<std::uint64_t> shed_{0};
  MonotonicTime last_due_{};
  MonotonicTime last_woken_{};
  Duration stalled_{};          // of the data clock at the last tick
  MonotonicTime idle_since_{};  // the end of the last work
};

}  // namespace maploop::vehicle
