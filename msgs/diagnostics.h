// This file defines what the runtime reports about itself.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "msgs/realtime_setting.h"
#include "msgs/time.h"

namespace maploop {

// Holds the counts of a latency histogram, so that two of them can be added without loss
// (runtime/core/histogram.h defines its buckets).
struct HistogramData {
  // One bucket that has counted a value.
  struct Bucket {
    Duration lowest{};        // the smallest value that it counts
    std::uint64_t count = 0;  // of the values in it

    void archive(auto& ar) { ar(lowest, count); }
  };
  std::vector<Bucket> buckets;    // ascending; empty ones are left out
  std::uint64_t below_range = 0;  // negative values, which the lowest bucket counts too
  std::uint64_t above_range = 0;  // values beyond the highest bucket
  Duration min{}, max{};          // exact; 0 if nothing was recorded

  void archive(auto& ar) { ar(buckets, below_range, above_range, min, max); }
};

// Describes one missed deadline and where the time went.
struct MissedDeadline {
  // One part of the latency; of a path, how much later it was than its budget.
  struct Part {
    std::string name;   // a stage, or what delayed the thread
    Duration lasted{};  // time that it took

    void archive(auto& ar) { ar(name, lasted); }
  };
  Time stamp{};             // of the tick, or of the sample
  Duration latency{};       // from release to result, or from the sensor's stamp to the state
  std::vector<Part> parts;  // where the time went; at most three

  // Returns the name of the longest part; empty if there is none.
  std::string guilty() const {
    const auto longest =
        std::max_element(parts.begin(), parts.end(),
                         [](const Part& a, const Part& b) { return a.lasted < b.lasted; });
    return longest == parts.end() ? std::string() : longest->name;
  }

  void archive(auto& ar) { ar(stamp, latency, parts); }
};

// Summarizes the latency of one thread, or of one path from sensor stamp to state, since the start.
struct LatencySummary {
  std::string name;                             // of the thread or the path
  std::uint64_t count = 0;                      // of the latencies recorded
  std::uint64_t misses = 0;                     // of `deadline`
  Duration deadline{};                          // 0 if none is declared
  Duration p50{}, p90{}, p99{}, p999{}, max{};  // 50, 90, 99, 99.9 % quantiles and maximum
  std::string guilty{};                         // longest part of the worst miss
  HistogramData histogram{};                    // the recorded values behind the figures above
  HistogramData omitted{};              // waits to be added to correct co-ordinated omission
  std::vector<MissedDeadline> worst{};  // at most ten, the longest first

  void archive(auto& ar) {
    ar(name, count, misses, deadline, p50, p90, p99, p999, max, guilty, histogram, omitted, worst);
  }
};

// Reports all latencies since the start, by thread and by path from a sensor to the state. Period
// jitter is how much the time between two wake-ups differs from that between their due
// times. Only `threads` has `omitted` waits, deadlines and misses, and `paths` has the latter two;
// the others are as recorded.
struct Deadlines {
  Time stamp{};                             // data time of the report
  std::vector<LatencySummary> threads;      // from release to result
  std::vector<LatencySummary> paths;        // from the sensor's stamp to the state that contains it
  std::vector<LatencySummary> wake_up{};    // by thread: from ready to running
  std::vector<LatencySummary> execution{};  // by thread: of one tick, sample or message
  std::vector<LatencySummary> period_jitter{};  // by fixed-rate thread

  void archive(auto& ar) { ar(stamp, threads, paths, wake_up, execution, period_jitter); }
};

// Describes one property of the car or of a sensor that the filter estimates while it runs.
struct EstimatedProperty {
  std::string name;             // in words
  std::string unit;             // of the value and both sigmas
  double value = 0.0;           // as estimated now
  double sigma = 0.0;           // its standard deviation now
  double sigma_at_start = 0.0;  // before any measurement
  bool observed = false;        // the motion has shown it: the sigma is below half of that

  void archive(auto& ar) { ar(name, unit, value, sigma, sigma_at_start, observed); }
};

// Reports what the filter has estimated of the car and its sensors.
struct SelfCalibration {
  Time stamp{};                               // data time of the report
  std::vector<EstimatedProperty> properties;  // none before the filter has started

  void archive(auto& ar) { ar(stamp, properties); }
};

// Counts the samples of one ring between two threads. While neither uses it, what was pushed is
// what was popped, lost, or is held.
struct RingHealth {
  std::string name;  // "imu -> fusion"
  // Samples that the producer offered, that the consumer took, that were not stored (mostly because
  // the ring was full), and that are in the ring now; and how many it can hold.
  std::uint64_t pushed = 0, popped = 0, lost = 0, held = 0, capacity = 0;

  void archive(auto& ar) { ar(name, pushed, popped, lost, held, capacity); }
};

// Describes the state of one thread: a sensor's driver or a stage.
struct ThreadHealth {
  std::string name;            // of the driver or the stage
  std::string scheduling;      // as the kernel granted it: "fifo 50", "other"
  std::uint64_t count = 0;     // samples or ticks so far
  double rate = 0.0;           // Hz of data time, over the last second
  std::string failure;         // empty while the thread runs
  double cpu = 0.0;            // s of processor time used so far
  std::uint64_t left_out = 0;  // ticks, by the overrun policy
  std::uint64_t shed = 0;      // samples thinned or left out by a driver under overload

  void archive(auto& ar) { ar(name, scheduling, count, rate, failure, cpu, left_out, shed); }
};

// Counts the measurements that an estimator has refused so far.
struct RefusalCount {
  std::string stage;        // that refused them
  std::string reason;       // in words
  std::uint64_t count = 0;  // of measurements with this reason

  void archive(auto& ar) { ar(stage, reason, count); }
};

// Counts the messages to one output: the bus, the log.
struct OutputHealth {
  std::string name;                    // "LCM", "log"
  std::uint64_t sent = 0, unsent = 0;  // messages taken; not sent or not written

  void archive(auto& ar) { ar(name, sent, unsent); }
};

// Compares a sensor's clock with the host's, from the arrival times of its messages.
struct SensorClock {
  bool known = false;                 // whether there are messages to compare
  std::optional<Duration> utc_ahead;  // its UTC minus the host's clock; nothing if unknown
  double drift = 0.0;                 // rate of the host's clock relative to it, minus 1
  Duration delay{};                   // of the last message, beyond the minimum
  std::uint64_t jumps = 0;            // how often a clock jumped and the comparison began anew

  void archive(auto& ar) { ar(known, utc_ahead, drift, delay, jumps); }
};

// Describes the state of a live sensor.
struct SensorHealth {
  std::string name;                          // of the driver
  std::string endpoint;                      // what it connects to: a port, a host, a pipeline
  bool connected = false;                    // whether the connection is open now
  std::uint64_t connections = 0;             // how often it was connected
  std::uint64_t delivered = 0, refused = 0;  // samples; packets and lines
  std::string problem;                       // why it is not connected
  SensorClock clock;                         // compared with the host's

  void archive(auto& ar) {
    ar(name, endpoint, connected, connections, delivered, refused, problem, clock);
  }
};

// Reports once a second how the whole run is doing.
struct Health {
  Time stamp{};                           // data time of the report
  std::vector<ThreadHealth> threads;      // drivers and stages
  std::vector<RingHealth> rings;          // between the threads
  std::vector<RefusalCount> refusals;     // those that occurred
  std::vector<OutputHealth> outputs;      // where messages go
  std::vector<SensorHealth> sensors;      // live ones
  std::vector<RealtimeSetting> settings;  // what was requested of the machine, and granted
  std::vector<std::string> degraded;      // each a sentence: what, since when, what to do
  double elapsed = 0.0;                   // s of this machine's time since the start
  double cpu = 0.0;                       // s of the whole process's processor time

  void archive(auto& ar) {
    ar(stamp, threads, rings, refusals, outputs, sensors, settings, degraded, elapsed, cpu);
  }
};

}  // namespace maploop
