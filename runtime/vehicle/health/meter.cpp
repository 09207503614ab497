#include "runtime/vehicle/health/meter.h"

namespace maploop::vehicle {
namespace {

MissedDeadline message_of(const Timing& timing) {
  MissedDeadline miss{timing.stamp, timing.latency, {}};
  for (const Timing::Part& part : timing.parts) {
    if (*part.name != '\0') miss.parts.push_back({part.name, part.lasted});
  }
  return miss;
}

}  // namespace

void WorstTimings::add(const Timing& timing) {
  if (count == misses.size() && timing.latency <= misses.back().latency) return;
  if (count < misses.size()) ++count;
  std::size_t at = count - 1;
  for (; at > 0 && misses[at - 1].latency < timing.latency; --at) misses[at] = misses[at - 1];
  misses[at] = timing;
}

bool Meter::record(const Timing& timing) {
  histogram_.record(timing.latency);
  if (timing.latency <= deadline_) return false;
  miss_count_.fetch_add(1, std::memory_order_relaxed);
  worst_.add(timing);
  published_.back() = worst_;
  published_.publish();
  return true;
}

LatencySummary Meter::summary() const {
  LatencySummary s = histogram_.summarize(name_);
  s.misses = miss_count();
  s.deadline = deadline_;
  s.omitted = omitted_.data();
  if (const WorstTimings* worst = published_.latest()) received_ = worst;
  for (std::size_t i = 0; received_ != nullptr && i < received_->count; ++i) {
    s.worst.push_back(message_of(received_->misses[i]));
  }
  if (!s.worst.empty()) s.guilty = s.worst.front().guilty();
  return s;
}

}  // namespace maploop::vehicle
