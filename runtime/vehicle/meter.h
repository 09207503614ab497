// How long something takes from release to result, how often it misses its deadline, and whose
// fault that was.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "msgs/diagnostics.h"
#include "runtime/core/histogram.h"
#include "runtime/core/latest_value.h"

namespace maploop::vehicle {

// What was to be done by a deadline, and where the time went. Names must outlive the meter.
struct Timing {
  struct Part {
    const char* name = "";
    Duration lasted{};
  };

  Time stamp{};  // of the tick, or of the sample
  Duration latency{};
  std::array<Part, 3> parts{};
};

// One thread records, without a lock, an allocation or a system call; one other thread at a time
// reads summary(), also meanwhile; the rest is for any thread.
class Meter {
 public:
  // deadline 0: none.
  Meter(std::string_view name, Duration deadline) : name_(name), deadline_(deadline) {}

  void record(Duration latency) { histogram_.record(latency); }

  // With its parts, for the case that the deadline was missed; whether it was.
  bool record(const Timing& timing);

  // The schedule of a periodic task was moved by `shift`: the ticks that would have been late
  // meanwhile are now on time, and are added to the omitted waits.
  void record_shift(Duration shift, Duration interval) { omitted_.record_omitted(shift, interval); }

  const std::string& name() const { return name_; }
  std::uint64_t count() const { return histogram_.count(); }
  std::uint64_t miss_count() const { return miss_count_.load(std::memory_order_relaxed); }
  const runtime::Histogram& histogram() const { return histogram_; }
  LatencySummary summary() const;

 private:
  // The longest misses so far, the longest first.
  struct Worst {
    std::array<Timing, 10> misses{};
    std::size_t count = 0;

    void add(const Timing& timing);
  };

  std::string name_;
  Duration deadline_;
  runtime::Histogram histogram_;
  runtime::Histogram omitted_;
  std::atomic<std::uint64_t> miss_count_{0};
  Worst worst_;                               // the recording thread's
  mutable runtime::LatestValue<Worst> told_;  // to the reading one
  mutable const Worst* heard_ = nullptr;      // by the reading one
};

}  // namespace maploop::vehicle
