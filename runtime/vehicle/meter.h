// How long something takes from release to result, how often it misses its deadline, and whose
// fault that was.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/diagnostics.h"
#include "runtime/core/histogram.h"

namespace maploop::vehicle {

// One missed deadline: where the time went. Names are string literals.
struct Miss {
  struct Part {
    const char* name = "";
    Duration lasted{};
  };

  Time stamp{};  // of the tick, or of the sample
  Duration latency{};
  std::array<Part, 3> parts{};

  // The largest part.
  const char* guilty() const;
};

// One thread records; any thread reads summary(). misses() only after the recording thread ended.
class Meter {
 public:
  // deadline 0: none.
  Meter(std::string_view name, Duration deadline) : name_(name), deadline_(deadline) {
    misses_.reserve(kept_misses);
  }

  void record(Duration latency) { histogram_.record(latency); }

  // With its parts, for the case that the deadline was missed; whether it was.
  bool record(const Miss& timing);

  const std::string& name() const { return name_; }
  std::uint64_t count() const { return histogram_.count(); }
  std::uint64_t miss_count() const { return miss_count_.load(std::memory_order_relaxed); }
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
  Duration worst_{};
  std::atomic<const char*> guilty_of_worst_{""};
  std::vector<Miss> misses_;
};

}  // namespace maploop::vehicle
