// Measures how long something takes from release to result, how often it misses its deadline, and
// which part took the longest.
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

// A Timing is the latency of one piece of work, and its parts. Names must outlive the meter.
struct Timing {
  struct Part {
    const char* name = "";
    Duration lasted{};
  };

  Time stamp{};  // stamp of the tick or of the sample
  Duration latency{};
  std::array<Part, 3> parts{};
};

// The ten longest misses so far, the longest first.
struct WorstTimings {
  std::array<Timing, 10> misses{};
  std::size_t count = 0;

  void add(const Timing& timing);
};

// One thread records, without a lock, an allocation or a system call. One other thread at a time
// may call summary(), also while the first one records. Any thread may call the rest.
class Meter {
 public:
  // A deadline of 0 means that there is none; record(Timing) would then count every latency as a
  // miss.
  Meter(std::string_view name, Duration deadline) : name_(name), deadline_(deadline) {}

  void record(Duration latency) { histogram_.record(latency); }

  // Records a latency with its parts, which are kept if the deadline was missed. Returns whether it
  // was.
  bool record(const Timing& timing);

  // Records that the schedule of a periodic task was moved by `shift`. The ticks that would have
  // been late meanwhile are now on time; their waits are added to the omitted ones.
  void record_shift(Duration shift, Duration interval) { omitted_.record_omitted(shift, interval); }

  const std::string& name() const { return name_; }
  std::uint64_t count() const { return histogram_.count(); }
  std::uint64_t miss_count() const { return miss_count_.load(std::memory_order_relaxed); }
  const runtime::Histogram& histogram() const { return histogram_; }
  LatencySummary summary() const;

 private:
  std::string name_;
  Duration deadline_;
  runtime::Histogram histogram_;
  runtime::Histogram omitted_;
  std::atomic<std::uint64_t> miss_count_{0};
  WorstTimings worst_;                                    // owned by the recording thread
  mutable runtime::LatestValue<WorstTimings> published_;  // passes worst_ to the reader
  mutable const WorstTimings* received_ = nullptr;        // owned by the reading thread
};

}  // namespace maploop::vehicle
