// How long one thread takes from release to result, how often it misses its deadline, and why.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "msgs/diagnostics.h"
#include "runtime/core/histogram.h"

namespace maploop::vehicle {

// Where the time of one missed deadline went.
struct Miss {
  Time stamp{};           // of the tick or of the sample that released the thread
  Duration woken_late{};  // the kernel started the thread this long after its release
  Duration waited{};      // for inputs that were due but not there
  Duration ran{};
};

// One thread records; any thread reads summary(). misses() only after the recording thread ended.
class Meter {
 public:
  // deadline 0: none.
  Meter(std::string name, Duration deadline) : name_(std::move(name)), deadline_(deadline) {
    misses_.reserve(kept_misses);
  }

  void record(Duration latency) { histogram_.record(latency); }

  // One release of a thread with a deadline.
  void record(const Miss& parts) {
    const Duration latency = parts.woken_late + parts.waited + parts.ran;
    histogram_.record(latency);
    if (latency <= deadline_) return;
    miss_count_.fetch_add(1, std::memory_order_relaxed);
    if (misses_.size() < kept_misses) misses_.push_back(parts);
  }

  const std::string& name() const { return name_; }
  std::uint64_t count() const { return histogram_.count(); }
  const runtime::Histogram& histogram() const { return histogram_; }
  LatencySummary summary() const;

  // The first few, in order.
  const std::vector<Miss>& misses() const { return misses_; }

 private:
  static constexpr std::size_t kept_misses = 32;

  std::string name_;
  Duration deadline_;
  runtime::Histogram histogram_;
  std::atomic<std::uint64_t> miss_count_{0};
  std::vector<Miss> misses_;
};

}  // namespace maploop::vehicle
