// Looks at threads, rings and meters while they run, and says what it sees.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "msgs/diagnostics.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/edge.h"
#include "runtime/core/thread.h"
#include "runtime/vehicle/thread_meter.h"

namespace maploop::vehicle {

// Set up before the threads run; afterwards one thread at a time looks. What is watched must
// outlive the monitor.
class HealthMonitor {
 public:
  // A thread of a stage.
  void watch(const runtime::Thread& thread, const ThreadMeter& meter);
  // A driver, by how late it releases its samples.
  void watch(const runtime::Thread& thread, const Meter& lateness);
  void watch_path(const Meter& path) { paths_.push_back(&path); }
  void watch(const runtime::EdgeBase& edge) { edges_.push_back(&edge); }

  // `elapsed`: data time since the last look, for the rates.
  Health health(Time stamp, Duration elapsed, const runtime::DataClock& clock);
  // The next health() counts from the start.
  void restart_rates();
  Deadlines deadlines(Time stamp) const;

 private:
  struct Watched {
    const runtime::Thread* thread;
    const ThreadMeter* meter;  // null of a driver
    const Meter* lateness;     // of a driver, else null

    std::uint64_t count() const { return meter != nullptr ? meter->count() : lateness->count(); }
    std::uint64_t seen = 0;
  };
  std::vector<Watched> threads_;
  std::vector<const Meter*> paths_;
  std::vector<const runtime::EdgeBase*> edges_;
};

}  // namespace maploop::vehicle
