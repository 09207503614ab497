// The fusion thread: the reduced-IMU filter at a fixed rate.
#pragma once

#include <atomic>
#include <optional>
#include <stop_token>
#include <utility>

#include "estimators/fusion/reduced_imu_filter.h"
#include "msgs/gnss.h"
#include "msgs/imu.h"
#include "msgs/nav_state.h"
#include "msgs/odometry.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/core/intake.h"
#include "runtime/core/latest_value.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/fault_delay.h"
#include "runtime/vehicle/meter.h"
#include "runtime/vehicle/thread_meter.h"

namespace maploop::vehicle {

// The edges that end at the fusion thread.
struct FusionEdges {
  FusionEdges();

  runtime::Doorbell bell;
  runtime::Edge<ImuSample> imu;
  runtime::Edge<GnssFix> gnss;
  runtime::Edge<RelativeMotion> odometry;
};

class FusionStage {
 public:
  FusionStage(fusion::ReducedImuFilter filter, FusionEdges& inputs,
              runtime::Edge<NavState>& nav_states, runtime::Edge<NavState>& image_states);

  // Ticks from `first` (data time) until the inputs are finished or stop is requested. Each tick
  // takes exactly what is available by then; while some of it is late, or when the ticks themselves
  // fall behind by several periods, the data clock is stalled.
  void run(runtime::DataClock& clock, Time first, const std::stop_token& stop);
  void finish();

  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }  // before run()
  void slow_down(StageDelay delay) { delay_ = std::move(delay); }   // before run()

  // Data time of the last tick; any thread may ask.
  Time position() const { return from_nanoseconds(position_.load(std::memory_order_relaxed)); }

  const ThreadMeter& meter() const { return meter_; }        // from the tick's release to its state
  const Meter& camera_path() const { return camera_path_; }  // from the image's stamp to the state
  const Meter& imu_path() const { return imu_path_; }        // from the IMU's stamp to the state

  // Of the filter at the end of the last tick; one thread at a time may ask, also meanwhile.
  const fusion::FilterStatus& filter_status() {
    if (const fusion::FilterStatus* status = filter_status_.latest()) known_status_ = status;
    return *known_status_;
  }

 private:
  bool tick(const runtime::Tick& tick, runtime::DataClock& clock, const std::stop_token& stop);
  void take(const RelativeMotion& motion);
  void record_paths(const runtime::DataClock& clock, MonotonicTime due, MonotonicTime done);

  fusion::ReducedImuFilter filter_;
  FusionEdges& inputs_;
  runtime::Edge<NavState>& nav_states_;
  runtime::Edge<NavState>& image_states_;
  runtime::Intake intake_;
  std::stop_token stop_;
  Time tick_{};
  std::atomic<std::int64_t> position_{0};
  std::uint64_t ticks_ = 0;
  std::uint64_t images_ = 0;
  std::optional<Sample> imu_taken_;       // by this tick, the last one
  std::optional<Sample> odometry_taken_;  // with a motion
  ThreadMeter meter_;
  Meter camera_path_;
  Meter imu_path_;
  StageDelay delay_;
  runtime::TraceBuffer* trace_ = nullptr;
  runtime::LatestValue<fusion::FilterStatus> filter_status_;
  const fusion::FilterStatus* known_status_ = &no_status_;  // the reader's
  fusion::FilterStatus no_status_;
};

}  // namespace maploop::vehicle
