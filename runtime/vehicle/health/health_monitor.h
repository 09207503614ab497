// Looks at threads, rings and meters while they run, and says what it sees.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/diagnostics.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/edge.h"
#include "runtime/core/realtime_setting.h"
#include "runtime/core/thread.h"
#include "runtime/vehicle/drivers/driver.h"
#include "runtime/vehicle/graph/stage_specs.h"
#include "runtime/vehicle/health/episodes.h"
#include "runtime/vehicle/health/thread_meter.h"
#include "runtime/vehicle/health/watchdog.h"
#include "runtime/vehicle/output/message_sink.h"

namespace maploop::vehicle {

// Set up before the threads run; afterwards one thread at a time looks. What is watched must
// outlive the monitor.
class HealthMonitor {
 public:
  // Of the data that are to come, and of the threads; times are said from `origin` on, the start of
  // the drive. Before watch_...().
  void start(Time first, MonotonicTime wall, Time origin);
  // A driver: when its samples come, and how late it releases them.
  void watch_driver(const runtime::Thread& thread, DriverBase& driver);
  // A sensor that this vehicle lacks.
  void watch_missing(const StageSpec& sensor) {
    if (sensor.min_rate > 0.0) missing_.push_back(sensor.name);
  }
  // A stage, and the rings that feed it.
  void watch_stage(const StageSpec& stage, const runtime::Thread& thread, const ThreadMeter& meter,
                   std::vector<runtime::EdgeBase*> inputs);
  void watch_path(const Meter& path) { paths_.push_back(&path); }
  void watch(const runtime::EdgeBase& edge) { edges_.push_back(&edge); }
  void watch(UseWatch& use) { uses_.push_back(&use); }
  void watch(const MessageSink& output) { outputs_.push_back(&output); }

  // `elapsed`: data time since the last look, for the rates.
  Health health(Time stamp, Duration elapsed, const runtime::DataClock& clock,
                const runtime::RealtimeReport& readiness);
  // The next health() counts from the start.
  void restart_rates();
  Deadlines deadlines(Time stamp) const;

  // Returns when each sensor was first found silent, and when each estimator was first found to
  // refuse or doubt its samples.
  std::vector<Naming> namings(Time now);

 private:
  struct Watched {
    const runtime::Thread* thread;
    const ThreadMeter* meter;
    DriverBase* driver;  // null for a stage
    std::vector<runtime::EdgeBase*> inputs;
    Watchdog watchdog;
    std::uint64_t seen = 0;
  };
  static StageFacts facts(const Watched& watched, std::uint64_t count);

  Time origin_{};
  Time first_{};
  MonotonicTime wall_start_{};
  std::vector<Watched> threads_;
  std::vector<std::string_view> missing_;
  std::vector<UseWatch*> uses_;
  std::vector<const Meter*> paths_;
  std::vector<const runtime::EdgeBase*> edges_;
  std::vector<const MessageSink*> outputs_;
};

}  // namespace maploop::vehicle
