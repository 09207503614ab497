#include "runtime/core/histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace maploop::runtime {
namespace {

// Only one thread writes, so no locked instruction is needed. The store is a release so that a
// reader that sees a count also sees its minimum and maximum.
void add(std::atomic<std::uint64_t>& counter, std::uint64_t times) {
  counter.store(counter.load(std::memory_order_relaxed) + times, std::memory_order_release);
}

void lower(std::atomic<std::int64_t>& extreme, std::int64_t value) {
  if (value < extreme.load(std::memory_order_relaxed)) {
    extreme.store(value, std::memory_order_relaxed);
  }
}

void raise(std::atomic<std::int64_t>& extreme, std::int64_t value) {
  if (value > extreme.load(std::memory_order_relaxed)) {
    extreme.store(value, std::memory_order_relaxed);
  }
}

}  // namespace

// Octave k >= 1 holds [2^(k + part_bits), 2^(k + part_bits + 1)) in parts of 2^k; smaller values (k
// = 0) have parts of 1.
std::size_t Histogram::bucket_of(std::int64_t value) {
  const auto magnitude = static_cast<std::uint64_t>(value);
  const int octave = std::max(0, static_cast<int>(std::bit_width(magnitude)) - 1 - part_bits);
  return static_cast<std::size_t>(octave) * part_count +
         static_cast<std::size_t>(magnitude >> static_cast<unsigned>(octave));
}

std::int64_t Histogram::highest_in(std::size_t bucket) {
  if (bucket < 2 * part_count) return static_cast<std::int64_t>(bucket);
  const std::size_t octave = bucket / part_count - 1;
  const std::size_t part = bucket - octave * part_count;
  return static_cast<std::int64_t>(((part + 1) << octave) - 1);
}

std::int64_t Histogram::lowest_in(std::size_t bucket) {
  return bucket == 0 ? 0 : highest_in(bucket - 1) + 1;
}

void Histogram::record(Duration value) {
  const std::int64_t ns = value.count();
  lower(min_, ns);
  raise(max_, ns);
  if (ns < 0) add(below_range_, 1);
  if (value > highest_duration) {
    add(above_range_, 1);
  } else {
    add(buckets_[bucket_of(std::max<std::int64_t>(ns, 0))], 1);
  }
}

void Histogram::merge(const Histogram& other) {
  const auto merge_extremes = [this, &other] {
    lower(min_, other.min_.load(std::memory_order_relaxed));
    raise(max_, other.max_.load(std::memory_order_relaxed));
  };
  merge_extremes();  // so that a reader of this histogram sees no count without them
  for (std::size_t i = 0; i < bucket_count; ++i) {
    const std::uint64_t times = other.buckets_[i].load(std::memory_order_acquire);
    if (times != 0) add(buckets_[i], times);
  }
  add(below_range_, other.below_range_.load(std::memory_order_acquire));
  add(above_range_, other.above_range_.load(std::memory_order_acquire));
  merge_extremes();  // for values that `other` recorded meanwhile
}

HistogramData Histogram::data() const {
  const Histogram frozen(*this);
  HistogramData data;
  for (std::size_t i = 0; i < bucket_count; ++i) {
    const std::uint64_t times = frozen.buckets_[i].load(std::memory_order_relaxed);
    if (times != 0) data.buckets.push_back({Duration(lowest_in(i)), times});
  }
  data.below_range = frozen.below_range();
  data.above_range = frozen.above_range();
  data.min = frozen.min();
  data.max = frozen.max();
  return data;
}

void Histogram::merge(const HistogramData& data) {
  check(data);
  if (data.buckets.empty() && data.above_range == 0) return;
  lower(min_, data.min.count());
  raise(max_, data.max.count());
  for (const HistogramData::Bucket& bucket : data.buckets) {
    add(buckets_[bucket_of(bucket.lowest.count())], bucket.count);
  }
  add(below_range_, data.below_range);
  add(above_range_, data.above_range);
}

void Histogram::check(const HistogramData& data) {
  const auto refuse = [](const std::string& why) {
    throw std::invalid_argument("histogram: " + why);
  };
  constexpr std::uint64_t most_counted = std::uint64_t{1}
                                         << 53;  // sums of a thousand of them still fit
  std::uint64_t in_lowest = 0;
  Duration last{-1};
  for (const HistogramData::Bucket& bucket : data.buckets) {
    const std::string name = "bucket of " + std::to_string(bucket.lowest.count()) + " ns";
    if (bucket.lowest <= last) refuse(name + " is not above the one before");
    if (bucket.lowest > highest_duration ||
        lowest_in(bucket_of(bucket.lowest.count())) != bucket.lowest.count()) {
      refuse(name + " is none of its buckets");
    }
    if (bucket.count == 0 || bucket.count > most_counted) {
      refuse(name + " has the count " + std::to_string(bucket.count));
    }
    if (bucket.lowest == Duration::zero()) in_lowest = bucket.count;
    last = bucket.lowest;
  }
  if (data.below_range > in_lowest || data.above_range > most_counted) {
    refuse("more values out of range than there are");
  }
  if (data.min > data.max) refuse("its minimum is above its maximum");
}

std::uint64_t Histogram::count() const {
  std::uint64_t sum = above_range_.load(std::memory_order_acquire);
  for (const auto& bucket : buckets_) sum += bucket.load(std::memory_order_acquire);
  return sum;
}

Duration Histogram::min() const {
  const std::int64_t value = min_.load(std::memory_order_relaxed);
  return value == Duration::max().count() ? Duration{} : Duration(value);
}

Duration Histogram::max() const {
  const std::int64_t value = max_.load(std::memory_order_relaxed);
  return value == Duration::min().count() ? Duration{} : Duration(value);
}

Duration Histogram::percentile(double fraction) const {
  if (!(fraction >= 0.0 && fraction <= 1.0)) {
    throw std::invalid_argument("histogram: percentile of fraction " + std::to_string(fraction) +
                                "; allowed is 0 to 1");
  }
  const std::uint64_t n = count();
  if (n == 0) return Duration{};
  // The step down before rounding up corrects rounding errors: 0.07 * 100 is slightly above 7.
  const double rank = std::ceil(std::nextafter(fraction * static_cast<double>(n), 0.0));
  std::uint64_t left = std::clamp<std::uint64_t>(static_cast<std::uint64_t>(rank), 1, n);
  for (std::size_t i = 0; i < bucket_count; ++i) {
    const std::uint64_t here = buckets_[i].load(std::memory_order_acquire);
    if (here >= left) return std::min(Duration(highest_in(i)), max());
    left -= here;
  }
  return max();  // beyond the range
}

LatencySummary Histogram::summarize(std::string name) const {
  const Histogram frozen(*this);
  LatencySummary summary;
  summary.name = std::move(name);
  summary.count = frozen.count();
  summary.p50 = frozen.percentile(0.5);
  summary.p90 = frozen.percentile(0.9);
  summary.p99 = frozen.percentile(0.99);
  summary.p999 = frozen.percentile(0.999);
  summary.max = frozen.max();
  summary.histogram = frozen.data();
  return summary;
}

// Adds value - k * interval for k = 1, 2, ... down to `interval`. It works bucket by bucket,
// because there may be billions of them.
void Histogram::record_omitted(Duration wait, Duration period) {
  const std::int64_t value = std::min(wait, highest_duration).count(), interval = period.count();
  const std::int64_t last = value / interval - 1;  // the largest k
  if (last < 1) return;
  for (std::size_t i = bucket_of(interval); i <= bucket_of(value - interval); ++i) {
    const std::int64_t highest = highest_in(i);
    const std::int64_t to = std::min(last, (value - lowest_in(i)) / interval);
    const std::int64_t from =
        highest >= value ? 1
                         : std::max<std::int64_t>(1, (value - highest + interval - 1) / interval);
    if (from <= to) add(buckets_[i], static_cast<std::uint64_t>(to - from + 1));
  }
  lower(min_, value - last * interval);
  raise(max_, value - interval);
}

}  // namespace maploop::runtime
