// This file defines a latency histogram of fixed memory (32 kB), 1 ns to 137 s, with an error below
// 0.8 %.
//
// The buckets are log-linear, like HdrHistogram's: each octave is cut into 128 equal parts, and
// each value below 256 ns has a bucket of its own. The width of a bucket is at most 1/128 of its
// values.
//
// Who may call what. record, record_omitted, merge: one thread at a time, the writer. All else: any
// thread, also while the writer records; each answer then counts every value recorded before the
// call and may count those recorded during it. Figures that must agree with each other (a
// percentile and its count) must be taken from a copy. Only data() and summarize() allocate; no
// function locks or enters the kernel.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include "msgs/diagnostics.h"
#include "msgs/time.h"

namespace maploop::runtime {

class Histogram {
 public:
  Histogram() = default;
  Histogram(const Histogram& other) { merge(other); }
  Histogram& operator=(const Histogram&) = delete;

  // A negative duration (a stamp ahead of the clock) counts as 0 ns and in below_range(); a
  // duration beyond highest_duration counts in above_range(). min() and max() keep the value
  // itself.
  void record(Duration value);

  // Adds the waits that a stall of `wait` hid from a task released every `period`: wait - period,
  // wait - 2 period, ... down to `period`. With record(wait) this is HdrHistogram's
  // recordWithExpectedInterval (Tene's correction of co-ordinated omission). A wait beyond
  // highest_duration counts as highest_duration. The work is limited to one step for each bucket.
  // Precondition: period > 0.
  void record_omitted(Duration wait, Duration period);

  // Adds the contents of `other`, which may be recording meanwhile.
  void merge(const Histogram& other);

  // data() returns the contents for another program; merge(data) adds them there without loss.
  // merge throws std::invalid_argument, and adds nothing, if the data are not a histogram's: a
  // bucket with a wrong lower limit, twice or out of order, or counts that do not fit.
  HistogramData data() const;
  void merge(const HistogramData& data);

  std::uint64_t count() const;  // of all values, including those out of range
  std::uint64_t below_range() const { return below_range_.load(std::memory_order_relaxed); }
  std::uint64_t above_range() const { return above_range_.load(std::memory_order_relaxed); }

  // These are exact; 0 if nothing was recorded.
  Duration min() const;
  Duration max() const;

  // Returns the nearest rank: of n values in ascending order, number ceil(fraction * n) (the first
  // for fraction 0), as the highest value of its bucket, but not above max(). So at least the share
  // `fraction` of the values is at or below it, and it is never below the exact nearest-rank
  // percentile and less than 0.8 % above; percentile(1) is max(). Returns 0 if nothing was
  // recorded, and max() if the rank falls on values beyond highest_duration. Throws
  // std::invalid_argument unless `fraction` is within 0..1.
  Duration percentile(double fraction) const;

  // Fills all members except the deadline and its misses, which the thread counts, and the omitted
  // waits.
  LatencySummary summarize(std::string name) const;

  // This is the longest duration with a bucket of its own: 2^37 - 1 ns, 137 s.
  static constexpr Duration highest_duration{(std::int64_t{1} << 37) - 1};

 private:
  static constexpr int part_bits = 7;  // 2^7 parts an octave: 0.8 %
  static constexpr std::size_t part_count = std::size_t{1} << part_bits;
  static constexpr std::size_t bucket_count = (37 - part_bits + 1) * part_count;

  static std::size_t bucket_of(std::int64_t value);
  static std::int64_t highest_in(std::size_t bucket);
  static std::int64_t lowest_in(std::size_t bucket);
  static void check(const HistogramData& data);

  std::array<std::atomic<std::uint64_t>, bucket_count> buckets_{};
  std::atomic<std::uint64_t> below_range_{0};
  std::atomic<std::uint64_t> above_range_{0};
  std::atomic<std::int64_t> min_{Duration::max().count()};
  std::atomic<std::int64_t> max_{Duration::min().count()};
};

}  // namespace maploop::runtime
