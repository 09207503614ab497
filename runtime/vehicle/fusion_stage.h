// The fusion thread: the reduced-IMU filter at a fixed rate.
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "estimators/fusion/guarded_filter.h"
#include "msgs/gnss.h"
#include "msgs/imu.h"
#include "msgs/map_feedback.h"
#include "msgs/nav_state.h"
#include "msgs/odometry.h"
#include "msgs/wheel_speed.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/core/intake.h"
#include "runtime/core/latest_value.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/episodes.h"
#include "runtime/vehicle/fault_delay.h"
#include "runtime/vehicle/meter.h"
#include "runtime/vehicle/stage_cuts.h"
#include "runtime/vehicle/thread_meter.h"

namespace maploop::vehicle {

// The edges that end at the fusion thread.
struct FusionEdges {
  // `closed`: the map feeds back.
  explicit FusionEdges(bool closed = false);

  runtime::Doorbell bell;
  runtime::Edge<ImuSample> imu;
  runtime::Edge<GnssFix> gnss;
  runtime::Edge<WheelSpeed> wheel;
  runtime::Edge<RelativeMotion> odometry;
  std::optional<runtime::Edge<MapFeedback>> feedback;
};

class FusionStage {
 public:
  // `odometry_budget`: of all stages between a camera and the odometry.
  // Each state goes to all of `nav_states`, the publisher's first.
  FusionStage(fusion::GuardedFilter filter, FusionEdges& inputs,
              std::vector<runtime::Edge<NavState>*> nav_states,
              runtime::Edge<NavState>& image_states, Duration odometry_budget);

  // Ticks from the first one at or after `first` (data time) until the inputs are finished or stop
  // is requested. Each tick takes exactly what is available by then; while some of it is late, or
  // when the ticks themselves fall behind by several periods, the data clock is stalled. On a live
  // clock it takes what is there, and what is late with a later tick.
  void run(runtime::DataClock& clock, Time first, const std::stop_token& stop);
  void finish();

  // Before run().
  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }
  fusion::Outcome start_from(const fusion::KnownStart& known) { return filter_.start(known); }
  void slow_down(StageDelay delay) { delay_ = std::move(delay); }
  void save_at(std::vector<Time> moments, runtime::Edge<StageSnapshot>& edge) {
    cuts_.set(std::move(moments), edge);
  }
  // Memory that what it saves usually takes at most.
  std::size_t saved_bytes() const {
    return filter_.largest_archive() + sent_image_states_.capacity() * sizeof(NavState) + 4096;
  }
  // Goes on from what was saved; throws ArchiveError, as ReducedImuFilter.
  void resume(std::span<const std::uint8_t> saved);

  // Data time of the last tick; any thread may ask.
  Time position() const { return from_nanoseconds(position_.load(std::memory_order_relaxed)); }

  const ThreadMeter& meter() const { return meter_; }        // from the tick's release to its state
  const Meter& camera_path() const { return camera_path_; }  // from the image's stamp to the state
  const Meter& imu_path() const { return imu_path_; }        // from the IMU's stamp to the state

  // What of each sensor the filter uses.
  std::array<UseWatch*, 4> uses() { return {&imu_use_, &gnss_use_, &wheel_use_, &odometry_use_}; }

  // Of the filter at the end of the last tick; one thread at a time may ask, also meanwhile.
  const fusion::FilterStatus& filter_status() {
    if (const fusion::FilterStatus* status = filter_status_.latest()) known_status_ = status;
    return *known_status_;
  }

 private:
  bool tick(const runtime::Tick& tick, runtime::DataClock& clock, const std::stop_token& stop);
  void take(const RelativeMotion& motion);
  void send(const NavState& state);
  void save_until(Time t, const std::stop_token& stop);
  template <class Archive, class Stage>
  static void describe(Archive& ar, Stage& stage);
  void record_paths(const runtime::DataClock& clock, MonotonicTime due, MonotonicTime done);

  fusion::GuardedFilter filter_;
  FusionEdges& inputs_;
  std::vector<runtime::Edge<NavState>*> nav_states_;
  runtime::Edge<NavState>& image_states_;
  Duration odometry_budget_;
  runtime::Intake intake_;
  std::stop_token stop_;
  Time tick_{};
  std::atomic<std::int64_t> position_{0};
  std::uint64_t ticks_ = 0;
  std::uint64_t images_ = 0;
  // What the last tick sent.
  std::vector<NavState> sent_states_;
  std::vector<NavState> sent_image_states_;
  StageCuts cuts_;
  std::optional<Sample> imu_taken_;       // by this tick, the last one
  std::optional<Sample> odometry_taken_;  // with a motion
  UseWatch imu_use_;
  UseWatch gnss_use_;
  UseWatch wheel_use_;
  UseWatch odometry_use_;
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
