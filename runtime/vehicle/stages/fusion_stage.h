// The fusion thread: the reduced-IMU filter at a fixed rate.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "estimators/fusion/guarded_filter.h"
#include "estimators/fusion/protection_monitor.h"
#include "msgs/odom_state.h"
#include "msgs/odometry.h"
#include "runtime/core/intake.h"
#include "runtime/core/latest_value.h"
#include "runtime/core/periodic.h"
#include "runtime/vehicle/graph/graph_stage.h"
#include "runtime/vehicle/health/meter.h"
#include "runtime/vehicle/stages/aid_doubts.h"

namespace maploop::vehicle {

class FusionStage final : public GraphStage {
 public:
  // `odometry_budget`: the sum of the budgets of all stages between a camera and the odometry.
  FusionStage(Rings& rings, fusion::GuardedFilter filter, fusion::ProtectionMonitor protection,
              Duration odometry_budget);

  // Each tick takes exactly what is available by then. While an input is late, or when the ticks
  // themselves fall behind by several periods, the data clock is stalled. On a live clock a tick
  // takes what has arrived; what is late goes to a later tick.
  void run(runtime::DataClock& clock, Time begin, const std::stop_token& stop) override;
  std::size_t saved_bytes() const override {
    return filter_.largest_archive(feedback_) + protection_.largest_archive() +
           sent_image_states_.capacity() * sizeof(FusedState) + 4096;
  }
  std::vector<UseWatch*> uses() override;
  std::vector<RefusalCount> refusals() override;

  // Before run(); what is remembered before a start.
  void recall(const fusion::RememberedCalibration& remembered) { filter_.recall(remembered); }
  void recall(const fusion::LastPlace& place) { filter_.recall(place); }
  fusion::Outcome start_from(const fusion::KnownStart& known) { return filter_.start(known); }

  // Data time of the last tick; any thread may ask.
  Time position() const { return from_nanoseconds(position_.load(std::memory_order_relaxed)); }

  const Meter& camera_path() const { return camera_path_; }  // from the image's stamp to the state
  const Meter& imu_path() const { return imu_path_; }        // from the IMU's stamp to the state

  // What the filter says of itself at the end of a tick.
  struct FilterReport {
    fusion::FilterStatus status;
    fusion::SelfCalibrations calibration;  // each sigma is 0 before the start
    std::optional<fusion::LastPlace> here;
  };
  // That of the last tick; one thread at a time may ask, also while it runs.
  const FilterReport& filter_report() {
    if (const FilterReport* report = filter_reports_.latest()) known_report_ = report;
    return *known_report_;
  }

 private:
  bool tick(const runtime::Tick& tick, runtime::DataClock& clock, const std::stop_token& stop);
  void take(const GnssFix& fix);
  void take(const RelativeMotion& motion);
  void send(const FusedState& state, const std::stop_token& stop);
  void save_until(Time t, const std::stop_token& stop);
  void load(ArchiveReader& ar) override { archive(ar); }
  template <class Archive>
  void archive(Archive& ar);
  void record_paths(const runtime::DataClock& clock, MonotonicTime due, MonotonicTime done);

  fusion::GuardedFilter filter_;
  fusion::ProtectionMonitor protection_;
  Outputs<FusedState> states_;
  Outputs<NavState> states_to_match_;
  Outputs<FusedState> image_states_;
  Outputs<CalibrationReport> calibrations_;
  Duration odometry_budget_;
  runtime::Intake intake_;
  bool feedback_ = false;  // the map feeds back
  std::stop_token stop_;
  Time tick_{};
  std::atomic<std::int64_t> position_{0};
  std::uint64_t ticks_ = 0;
  std::uint64_t images_ = 0;
  // What the last tick sent.
  std::vector<FusedState> sent_states_;
  std::vector<FusedState> sent_image_states_;
  std::optional<Sample> imu_taken_;       // by this tick, the last one
  std::optional<Sample> odometry_taken_;  // with a motion
  UseWatch imu_use_;
  UseWatch gnss_use_;
  UseWatch wheel_use_;
  UseWatch odometry_use_;
  AidDoubts doubts_;
  Meter camera_path_;
  Meter imu_path_;
  runtime::LatestValue<FilterReport> filter_reports_;
  const FilterReport* known_report_ = &no_report_;  // the reader's
  FilterReport no_report_;
};

}  // namespace maploop::vehicle
