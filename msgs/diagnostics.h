// What the runtime says of itself.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "msgs/realtime_setting.h"
#include "msgs/time.h"

namespace maploop {

// Latency of one thread or of one path from sensor stamp to state.
struct LatencySummary {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t misses = 0;  // of `deadline`
  Duration deadline{};       // 0: none declared
  Duration p50{}, p90{}, p99{}, p999{}, max{};
  std::string guilty;  // of the worst miss: the stage, or what the thread was held up by
};

struct Deadlines {
  Time stamp{};
  std::vector<LatencySummary> threads;  // from release to result
  std::vector<LatencySummary> paths;    // from the sensor's stamp to the state that holds it
};

struct RingHealth {
  std::string name;
  std::uint64_t pushed = 0, popped = 0, lost = 0, held = 0, capacity = 0;
};

struct ThreadHealth {
  std::string name;
  std::string scheduling;   // what the kernel granted: "fifo 50", "other"
  std::uint64_t count = 0;  // samples or ticks so far
  double rate = 0.0;        // Hz of data time, over the last second
  std::string failure;      // empty while it runs
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

struct Health {
  Time stamp{};
  std::vector<ThreadHealth> threads;
  std::vector<RingHealth> rings;
  std::vector<RefusalCount> refusals;  // those that happened
  std::vector<OutputHealth> outputs;
  std::vector<RealtimeSetting> settings;
  std::vector<std::string> degraded;  // each a sentence: what, since when, what to do
};

}  // namespace maploop
