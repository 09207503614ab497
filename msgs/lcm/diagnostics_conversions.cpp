#include <cmath>

#include "msgs/lcm/conversions.h"
#include "msgs/lcm/field_copy.h"

namespace maploop {

void convert(auto copy, Is<HistogramData> auto& h, auto& m) {
  copy(h.below_range, m.below_range);
  copy(h.above_range, m.above_range);
  copy(h.min, m.min_ns);
  copy(h.max, m.max_ns);
  if constexpr (copy.to_message) m.bucket_count = static_cast<std::int32_t>(h.buckets.size());
  copy.column(h.buckets, &HistogramData::Bucket::lowest, m.lowest_ns);
  copy.column(h.buckets, &HistogramData::Bucket::count, m.counts);
}

void convert(auto copy, Is<MissedDeadline::Part> auto& part, auto& m) {
  copy(part.name, m.name);
  copy(part.lasted, m.lasted_ns);
}

void convert(auto copy, Is<MissedDeadline> auto& miss, auto& m) {
  copy(miss.stamp, m.stamp_ns);
  copy(miss.latency, m.latency_ns);
  copy.each(miss.parts, m.parts, m.part_count);
}

void convert(auto copy, Is<LatencySummary> auto& s, auto& m) {
  copy(s.name, m.name);
  copy(s.count, m.count);
  copy(s.misses, m.misses);
  copy.microseconds(s.deadline, m.deadline_us);
  copy.microseconds(s.p50, m.p50_us);
  copy.microseconds(s.p90, m.p90_us);
  copy.microseconds(s.p99, m.p99_us);
  copy.microseconds(s.p999, m.p999_us);
  copy.microseconds(s.max, m.max_us);
  copy(s.guilty, m.guilty);
  convert(copy, s.histogram, m.histogram);
  convert(copy, s.omitted, m.omitted);
  copy.each(s.worst, m.worst, m.worst_count);
}

void convert(auto copy, Is<Deadlines> auto& deadlines, auto& m) {
  copy.utime(deadlines.stamp, m.utime);
  copy.each(deadlines.threads, m.threads, m.thread_count);
  copy.each(deadlines.paths, m.paths, m.path_count);
  copy.each(deadlines.wake_up, m.wake_up, m.wake_up_count);
  copy.each(deadlines.execution, m.execution, m.execution_count);
  copy.each(deadlines.period_jitter, m.period_jitter, m.jitter_count);
}
MAPLOOP_CONVERSIONS(Deadlines, maploop_lcm::deadlines_t)

void convert(auto copy, Is<EstimatedProperty> auto& p, auto& m) {
  copy(p.name, m.name);
  copy(p.unit, m.unit);
  copy(p.value, m.value);
  copy(p.sigma, m.sigma);
  copy(p.sigma_at_start, m.sigma_at_start);
  copy(p.observed, m.observed);
}

void convert(auto copy, Is<SelfCalibration> auto& calibration, auto& m) {
  copy.utime(calibration.stamp, m.utime);
  copy.each(calibration.properties, m.properties, m.property_count);
}
MAPLOOP_CONVERSIONS(SelfCalibration, maploop_lcm::self_calibration_t)

void convert(auto copy, Is<ThreadHealth> auto& t, auto& m) {
  copy(t.name, m.name);
  copy(t.scheduling, m.scheduling);
  copy(t.count, m.count);
  copy(t.rate, m.rate_hz);
  copy(t.failure, m.failure);
  copy(t.cpu, m.cpu_s);
  copy(t.left_out, m.left_out);
  copy(t.shed, m.shed);
}

void convert(auto copy, Is<RingHealth> auto& r, auto& m) {
  copy(r.name, m.name);
  copy(r.pushed, m.pushed);
  copy(r.popped, m.popped);
  copy(r.lost, m.lost);
  copy(r.held, m.held);
  copy(r.capacity, m.capacity);
}

void convert(auto copy, Is<RefusalCount> auto& r, auto& m) {
  copy(r.stage, m.stage);
  copy(r.reason, m.reason);
  copy(r.count, m.count);
}

void convert(auto copy, Is<OutputHealth> auto& o, auto& m) {
  copy(o.name, m.name);
  copy(o.sent, m.sent);
  copy(o.unsent, m.unsent);
}

void convert(auto copy, Is<SensorHealth> auto& s, auto& m) {
  copy(s.name, m.name);
  copy(s.endpoint, m.endpoint);
  copy(s.connected, m.connected);
  copy(s.connections, m.connections);
  copy(s.delivered, m.delivered);
  copy(s.refused, m.refused);
  copy(s.problem, m.problem);
  copy(s.clock.known, m.clock_known);
  if constexpr (copy.to_message) {
    m.utc_ahead_s = s.clock.utc_ahead ? to_seconds(*s.clock.utc_ahead) : std::nan("");
  } else if (std::isfinite(m.utc_ahead_s)) {
    s.clock.utc_ahead = checked_seconds(m.utc_ahead_s);
  }
  copy(s.clock.drift, m.clock_drift);
  copy.seconds(s.clock.delay, m.clock_delay_s);
  copy(s.clock.jumps, m.clock_jumps);
}

void convert(auto copy, Is<RealtimeSetting> auto& s, auto& m) {
  copy(s.name, m.name);
  copy(s.asked, m.asked);
  copy(s.granted, m.granted);
  copy.choice(s.verdict, m.verdict, "realtime_setting_t.verdict");
  copy(s.reason, m.reason);
  copy(s.remedy, m.remedy);
}

void convert(auto copy, Is<Health> auto& health, auto& m) {
  copy.utime(health.stamp, m.utime);
  copy.each(health.threads, m.threads, m.thread_count);
  copy.each(health.rings, m.rings, m.ring_count);
  copy.each(health.refusals, m.refusals, m.refusal_count);
  copy.each(health.outputs, m.outputs, m.output_count);
  copy.each(health.sensors, m.sensors, m.sensor_count);
  copy.each(health.settings, m.settings, m.setting_count);
  copy.each(health.degraded, m.degraded, m.degraded_count);
  copy(health.elapsed, m.elapsed_s);
  copy(health.cpu, m.cpu_s);
}
MAPLOOP_CONVERSIONS(Health, maploop_lcm::health_t)

}  // namespace maploop
