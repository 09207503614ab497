#include "runtime/vehicle/meter.h"

#include <algorithm>

namespace maploop::vehicle {

const char* Miss::guilty() const {
  return std::max_element(parts.begin(), parts.end(),
                          [](const Part& a, const Part& b) { return a.lasted < b.lasted; })
      ->name;
}

bool Meter::record(const Miss& timing) {
  histogram_.record(timing.latency);
  if (timing.latency <= deadline_) return false;
  miss_count_.fetch_add(1, std::memory_order_relaxed);
  if (timing.latency > worst_) {
    worst_ = timing.latency;
    guilty_of_worst_.store(timing.guilty(), std::memory_order_relaxed);
  }
  if (misses_.size() < kept_misses) misses_.push_back(timing);
  return true;
}

LatencySummary Meter::summary() const {
  LatencySummary s = histogram_.summarize(name_);
  s.misses = miss_count();
  s.deadline = deadline_;
  s.guilty = guilty_of_worst_.load(std::memory_order_relaxed);
  return s;
}

}  // namespace maploop::vehicle
