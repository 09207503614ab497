#include "tools/log/interval_statistics.h"

#include <algorithm>
#include <cmath>

#include "tools/log/log_text.h"

namespace maploop::lcm_log {

void IntervalStatistics::add(std::int64_t time_us) {
  const std::int64_t from = last_us_;
  last_us_ = time_us;
  if (++times_ == 1) return;
  const double interval = seconds_between(from, time_us);
  if (interval < 0.0) ++backwards_;
  histogram_.record(from_seconds(std::clamp(interval, -1e9, 1e9)));
  const double off = interval - mean_;
  mean_ += off / static_cast<double>(times_ - 1);
  squares_ += off * (interval - mean_);
  if (interval > longest_s_) {
    longest_s_ = interval;
    longest_from_us_ = from;
  }
}

double IntervalStatistics::deviation_s() const {
  return times_ < 3 ? 0.0 : std::sqrt(squares_ / static_cast<double>(times_ - 2));
}

std::uint64_t IntervalStatistics::longer_than_median(double factor) const {
  const auto intervals = histogram_.count();
  const double limit = factor * median_s();
  std::uint64_t low = 0, high = intervals;  // bounds of the number up to `limit`
  while (low < high) {
    const std::uint64_t middle = (low + high + 1) / 2;
    const double rank = static_cast<double>(middle) - 0.5;
    if (to_seconds(histogram_.percentile(rank / static_cast<double>(intervals))) <= limit) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return intervals - low;
}

}  // namespace maploop::lcm_log
