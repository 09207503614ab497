#include "runtime/vehicle/meter.h"

namespace maploop::vehicle {

LatencySummary Meter::summary() const {
  LatencySummary s = histogram_.summarize(name_);
  s.misses = miss_count_.load(std::memory_order_relaxed);
  s.deadline = deadline_;
  return s;
}

}  // namespace maploop::vehicle
