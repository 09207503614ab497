// What the runtime says of itself.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "msgs/realtime_setting.h"
#include "msgs/time.h"

namespace maploop {

// What a latency histogram holds, so that two of them can be added without loss
// (runtime/core/histogram.h has its buckets).
struct HistogramData {
  struct Bucket {
    Duration lowest{};  // of the values that it counts
    std::uint64_t count = 0;
  };
  std::vector<Bucket> buckets;    // ascending, none empty
  std::uint64_t below_range = 0;  // of those in the lowest bucket: negative values
  std::uint64_t above_range = 0;  // values beyond the highest bucket
  Duration min{}, max{};          // exact; 0 where nothing was recorded
};

// One missed deadline: where the time went.
struct MissedDeadline {
  struct Part {
    std::string name;  // a stage, or what held the thread up
    Duration lasted{};
  };
  Time stamp{};  // of the tick, or of the sample
  Duration latency{};
  std::vector<Part> parts;

  // The name of the longest part.
  std::string guilty() const {
    const auto longest =
        std::max_element(parts.begin(), parts.end(),
                         [](const Part& a, const Part& b) { return a.lasted < b.lasted; });
    return longest == parts.end() ? std::string() : longest->name;
  }
};

// Latency of one thread or of one path from sensor stamp to state, since the start.
struct LatencySummary {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t misses = 0;  // of `deadline`
  Duration deadline{};       // 0: none declared
  Duration p50{}, p90{}, p99{}, p999{}, max{};
  std::string guilty{};                 // of the worst miss: its longest part
  HistogramData histogram{};            // what the figures above are of: as recorded
  HistogramData omitted{};              // waits to be added to correct co-ordinated omission
  std::vector<MissedDeadline> worst{};  // at most ten, the longest first
};

// Period jitter: how far the time between two wake-ups is from that between their due times.
// Only `threads` has `omitted` waits, deadlines and misses, and `paths` the latter two; the others
// are as recorded.
struct Deadlines {
  Time stamp{};
  std::vector<LatencySummary> threads;      // from release to result
  std::vector<LatencySummary> paths;        // from the sensor's stamp to the state that holds it
  std::vector<LatencySummary> wake_up{};    // per thread: from when it could run until it did
  std::vector<LatencySummary> execution{};  // per thread: of one tick, sample or message
  std::vector<LatencySummary> period_jitter{};  // per fixed-rate thread
};

struct RingHealth {
  std::string name;
  std::uint64_t pushed = 0, popped = 0, lost = 0, held = 0, capacity = 0;
};

struct ThreadHealth {
  std::string name;
  std::string scheduling;                // what the kernel granted: "fifo 50", "other"
  std::uint64_t count = 0;               // samples or ticks so far
  double rate = 0.0;                     // Hz of data time, over the last second
  std::string failure;                   // empty while it runs
  double cpu = 0.0;                      // seconds of processor time used so far
  std::uint64_t left_out = 0, shed = 0;  // ticks, by the overrun policy
};

// Measurements that an estimator did not use, so far.
struct RefusalCount {
  std::string stage;
  std::string reason;
  std::uint64_t count = 0;
};

// Where messages go: the bus, the log.
struct OutputHealth {
  std::string name;
  std::uint64_t sent = 0, unsent = 0;  // messages
};

// A sensor's clock against the host's, by when its messages arrive.
struct SensorClock {
  bool known = false;
  std::optional<Duration> utc_ahead;  // its UTC before the host's clock; nothing: it says none
  double drift = 0.0;                 // how fast the host's clock runs beyond the sensor's, 1
  Duration delay{};                   // of the last message, beyond the least
  std::uint64_t jumps = 0;
};

// A live sensor.
struct SensorHealth {
  std::string name;
  std::string endpoint;
  bool connected = false;
  std::uint64_t connections = 0;             // times
  std::uint64_t delivered = 0, refused = 0;  // samples; packets and lines
  std::string problem;                       // why it is not connected
  SensorClock clock;
};

struct Health {
  Time stamp{};
  std::vector<ThreadHealth> threads;
  std::vector<RingHealth> rings;
  std::vector<RefusalCount> refusals;  // those that happened
  std::vector<OutputHealth> outputs;
  std::vector<SensorHealth> sensors;  // live ones
  std::vector<RealtimeSetting> settings;
  std::vector<std::string> degraded;  // each a sentence: what, since when, what to do
  double elapsed = 0.0;               // seconds of this machine's time since the start
  double cpu = 0.0;                   // seconds of processor time that the whole process used in it
};

}  // namespace maploop
