#include "msgs/lcm/conversion_parts.h"
#include "msgs/lcm/conversions.h"

namespace maploop {
namespace {

double to_us(Duration d) {
  return static_cast<double>(d.count()) * 1e-3;
}
Duration from_us(double us) {
  return from_seconds(us * 1e-6);
}

maploop_lcm::histogram_t to_lcm(const HistogramData& h) {
  maploop_lcm::histogram_t m{};
  m.below_range = static_cast<std::int64_t>(h.below_range);
  m.above_range = static_cast<std::int64_t>(h.above_range);
  m.min_ns = h.min.count();
  m.max_ns = h.max.count();
  m.bucket_count = static_cast<std::int32_t>(h.buckets.size());
  for (const HistogramData::Bucket& bucket : h.buckets) {
    m.lowest_ns.push_back(bucket.lowest.count());
    m.counts.push_back(static_cast<std::int64_t>(bucket.count));
  }
  return m;
}

HistogramData from_lcm(const maploop_lcm::histogram_t& m) {
  HistogramData h;
  h.below_range = static_cast<std::uint64_t>(m.below_range);
  h.above_range = static_cast<std::uint64_t>(m.above_range);
  h.min = Duration(m.min_ns);
  h.max = Duration(m.max_ns);
  for (std::size_t i = 0; i < m.lowest_ns.size(); ++i) {
    h.buckets.push_back({Duration(m.lowest_ns[i]), static_cast<std::uint64_t>(m.counts[i])});
  }
  return h;
}

maploop_lcm::time_part_t to_lcm(const MissedDeadline::Part& part) {
  maploop_lcm::time_part_t m{};
  m.name = part.name;
  m.lasted_ns = part.lasted.count();
  return m;
}

MissedDeadline::Part from_lcm(const maploop_lcm::time_part_t& m) {
  return {m.name, Duration(m.lasted_ns)};
}

maploop_lcm::missed_deadline_t to_lcm(const MissedDeadline& miss) {
  maploop_lcm::missed_deadline_t m{};
  m.stamp_ns = to_nanoseconds(miss.stamp);
  m.latency_ns = miss.latency.count();
  convert_each(miss.parts, m.parts, to_lcm);
  m.part_count = static_cast<std::int32_t>(m.parts.size());
  return m;
}

MissedDeadline from_lcm(const maploop_lcm::missed_deadline_t& m) {
  MissedDeadline miss;
  miss.stamp = from_nanoseconds(m.stamp_ns);
  miss.latency = Duration(m.latency_ns);
  convert_each(m.parts, miss.parts, from_lcm);
  return miss;
}

maploop_lcm::latency_summary_t to_lcm(const LatencySummary& s) {
  maploop_lcm::latency_summary_t m{};
  m.name = s.name;
  m.count = static_cast<std::int64_t>(s.count);
  m.misses = static_cast<std::int64_t>(s.misses);
  m.deadline_us = to_us(s.deadline);
  m.p50_us = to_us(s.p50);
  m.p90_us = to_us(s.p90);
  m.p99_us = to_us(s.p99);
  m.p999_us = to_us(s.p999);
  m.max_us = to_us(s.max);
  m.guilty = s.guilty;
  m.histogram = to_lcm(s.histogram);
  m.omitted = to_lcm(s.omitted);
  convert_each(s.worst, m.worst, to_lcm);
  m.worst_count = static_cast<std::int32_t>(m.worst.size());
  return m;
}

LatencySummary from_lcm(const maploop_lcm::latency_summary_t& m) {
  LatencySummary s;
  s.name = m.name;
  s.count = static_cast<std::uint64_t>(m.count);
  s.misses = static_cast<std::uint64_t>(m.misses);
  s.deadline = from_us(m.deadline_us);
  s.p50 = from_us(m.p50_us);
  s.p90 = from_us(m.p90_us);
  s.p99 = from_us(m.p99_us);
  s.p999 = from_us(m.p999_us);
  s.max = from_us(m.max_us);
  s.guilty = m.guilty;
  s.histogram = from_lcm(m.histogram);
  s.omitted = from_lcm(m.omitted);
  convert_each(m.worst, s.worst, from_lcm);
  return s;
}

}  // namespace

maploop_lcm::deadlines_t to_lcm(const Deadlines& deadlines) {
  maploop_lcm::deadlines_t m{};
  m.utime = microseconds_of(deadlines.stamp);
  convert_each(deadlines.threads, m.threads, to_lcm);
  convert_each(deadlines.paths, m.paths, to_lcm);
  convert_each(deadlines.wake_up, m.wake_up, to_lcm);
  convert_each(deadlines.execution, m.execution, to_lcm);
  convert_each(deadlines.period_jitter, m.period_jitter, to_lcm);
  m.thread_count = static_cast<std::int32_t>(m.threads.size());
  m.path_count = static_cast<std::int32_t>(m.paths.size());
  m.wake_up_count = static_cast<std::int32_t>(m.wake_up.size());
  m.execution_count = static_cast<std::int32_t>(m.execution.size());
  m.jitter_count = static_cast<std::int32_t>(m.period_jitter.size());
  return m;
}

Deadlines from_lcm(const maploop_lcm::deadlines_t& m) {
  Deadlines deadlines;
  deadlines.stamp = time_of_utime(m.utime);
  convert_each(m.threads, deadlines.threads, from_lcm);
  convert_each(m.paths, deadlines.paths, from_lcm);
  convert_each(m.wake_up, deadlines.wake_up, from_lcm);
  convert_each(m.execution, deadlines.execution, from_lcm);
  convert_each(m.period_jitter, deadlines.period_jitter, from_lcm);
  return deadlines;
}

}  // namespace maploop
