#include "runtime/vehicle/meter.h"

#include <utility>

namespace maploop::vehicle {

LatencySummary summarize(std::string name, const runtime::Histogram& histogram) {
  LatencySummary s;
  s.name = std::move(name);
  s.count = histogram.count();
  s.p50 = histogram.percentile(0.5);
  s.p90 = histogram.percentile(0.9);
  s.p99 = histogram.percentile(0.99);
  s.p999 = histogram.percentile(0.999);
  s.max = histogram.max();
  return s;
}

LatencySummary Meter::summary() const {
  LatencySummary s = summarize(name_, histogram_);
  s.misses = miss_count_.load(std::memory_order_relaxed);
  s.deadline = deadline_;
  return s;
}

}  // namespace maploop::vehicle
