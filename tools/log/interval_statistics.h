// Statistics of the intervals between one channel's messages, in bounded memory.
#pragma once

#include <cstdint>

#include "runtime/core/histogram.h"

namespace maploop::lcm_log {

class IntervalStatistics {
 public:
  // Times are in microseconds, in the order of the log.
  void add(std::int64_t time_us);

  double median_s() const { return to_seconds(histogram_.percentile(0.5)); }
  double deviation_s() const;  // standard deviation; 0 for fewer than two intervals
  double longest_s() const { return longest_s_; }
  std::int64_t longest_from_us() const { return longest_from_us_; }
  std::uint64_t backwards() const { return backwards_; }

  // Returns the number of intervals longer than `factor` times the median.
  std::uint64_t longer_than_median(double factor) const;

 private:
  runtime::Histogram histogram_;
  std::uint64_t times_ = 0;
  std::int64_t last_us_ = 0;
  double mean_ = 0.0, squares_ = 0.0;  // Welford's running mean and sum of squared deviations, s
  double longest_s_ = 0.0;
  std::int64_t longest_from_us_ = 0;
  std::uint64_t backwards_ = 0;
};

}  // namespace maploop::lcm_log
