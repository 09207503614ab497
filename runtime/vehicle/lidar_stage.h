// The lidar thread: the visual-LiDAR odometer at each scan and each visual motion.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "estimators/lidar/disparity_correction.h"
#include "estimators/lidar/lidar_odometry.h"
#include "msgs/lidar_scan.h"
#include "msgs/odometry.h"
#include "msgs/visual_motion.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/core/intake.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/episodes.h"
#include "runtime/vehicle/fault_delay.h"
#include "runtime/vehicle/preview_stage.h"
#include "runtime/vehicle/stage_cuts.h"
#include "runtime/vehicle/thread_meter.h"
#include "runtime/vehicle/watchdog.h"

namespace maploop::vehicle {

// The edges that end at the lidar thread.
struct LidarEdges {
  LidarEdges();

  runtime::Doorbell bell;
  runtime::Edge<LidarScan> scans;
  runtime::Edge<VisualMotion> visual;
};

// A scan and the visual motion of the image pair taken during its turn go together, whichever comes
// first: it waits for the other, at most the stage's patience (graph.h), or until it is clear that
// the other does not come. A visual motion that goes alone is passed on, given the length that the
// scans so far say. It waits only where a scan is due: one of the two turns behind the last.
// What was used, and when, depends on the data's times alone.
class LidarStage {
 public:
  // `odometry`: what fusion gets, to each of these edges.
  LidarStage(lidar::LidarOdometry odometer, lidar::DisparityCorrection correction,
             LidarEdges& inputs, runtime::Edge<LidarMotion>& lidar,
             std::vector<runtime::Edge<RelativeMotion>*> odometry);

  // Until the inputs are finished or stop is requested.
  void run(const runtime::DataClock& clock, const std::stop_token& stop);
  void finish();

  // Before run().
  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }
  // At most so many points of a scan.
  void show_to(AskedScan& preview, std::size_t points) {
    preview_ = &preview;
    preview_points_ = points;
  }
  void slow_down(StageDelay delay) { delay_ = std::move(delay); }
  void save_at(std::vector<Time> moments, runtime::Edge<StageSnapshot>& edge) {
    cuts_.set(std::move(moments), edge);
  }
  // Memory that what it saves usually takes at most.
  std::size_t saved_bytes() const;
  // Goes on from what was saved; throws ArchiveError, as LidarOdometry.
  void resume(std::span<const std::uint8_t> saved);

  const ThreadMeter& meter() const { return meter_; }
  UseWatch& use() { return use_; }
  // Scans so far with this status; any thread may ask.
  std::uint64_t count(OdometryStatus status) const {
    return counts_[static_cast<std::size_t>(status)].load(std::memory_order_relaxed);
  }

 private:
  void take(LidarScan& scan);
  void take(const VisualMotion& visual);
  void take_until(Time t);
  void let_go_until(Time t);
  bool scan_is_due(Time t) const;
  void match(Time now);
  void scan_goes_alone(Time trigger, MonotonicTime released);
  void visual_goes_alone(Time trigger, MonotonicTime released);
  void process(const LidarScan* scan, const VisualMotion* visual, Time trigger,
               MonotonicTime released);
  void show(const LidarScan& scan);
  void measure(Time trigger, Time stamp, MonotonicTime released, MonotonicTime started,
               MonotonicTime ended);
  void send(const LidarMotion& motion);
  void send(const RelativeMotion& motion);
  void resend();
  void save_until(Time t);
  void forget_sent(Time t);
  template <class Archive, class Stage>
  static void describe(Archive& ar, Stage& stage);
  void promise(Time t);

  lidar::LidarOdometry odometer_;
  lidar::DisparityCorrection correction_;
  LidarEdges& inputs_;
  runtime::Edge<LidarMotion>& lidar_;
  std::vector<runtime::Edge<RelativeMotion>*> odometry_;
  runtime::Intake intake_;
  const runtime::DataClock* clock_ = nullptr;
  std::stop_token stop_;
  // At most one of them waits.
  LidarScan scan_;
  bool scan_waits_ = false;
  VisualMotion visual_;
  bool visual_waits_ = false;
  Time turn_begin_{}, turn_end_{};  // of the last scan
  // Those that were not yet available at the last step.
  std::vector<LidarMotion> sent_lidar_;
  std::vector<RelativeMotion> sent_odometry_;
  UseWatch use_{stages::lidar.name, "scans", Watchdog::patience(stages::lidar)};
  ThreadMeter meter_;
  runtime::TraceBuffer* trace_ = nullptr;
  AskedScan* preview_ = nullptr;  // nullptr: nobody looks on
  std::size_t preview_points_ = 0;
  StageDelay delay_;
  StageCuts cuts_;
  std::array<std::atomic<std::uint64_t>, odometry_status_count> counts_{};
};

}  // namespace maploop::vehicle
