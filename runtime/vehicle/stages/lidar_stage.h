// The lidar thread: the visual-LiDAR odometer at each scan and each visual motion.
#pragma once

#include <cstddef>
#include <stop_token>
#include <vector>

#include "estimators/lidar/visual_lidar_odometer.h"
#include "msgs/lidar_scan.h"
#include "msgs/odometry.h"
#include "msgs/visual_motion.h"
#include "runtime/core/intake.h"
#include "runtime/vehicle/drivers/sensor_delays.h"
#include "runtime/vehicle/graph/graph_stage.h"
#include "runtime/vehicle/health/reason_counts.h"
#include "runtime/vehicle/health/watchdog.h"
#include "runtime/vehicle/stages/preview_stage.h"

namespace maploop::vehicle {

// Processes a scan together with the visual motion of the image pair that was taken during its
// turn. Whichever comes first waits for the other, at most for the stage's patience
// (stage_specs.h) and the larger delay of both sensors, whose samples come so much later after
// their stamps, or until it is certain that the other does not come. A visual motion waits only
// if a scan is due within two turns after the last one. A visual motion without a scan is passed on
// with the length that the scans so far suggest. What is used, and when, depends on the times of
// the data alone.
class LidarStage final : public GraphStage {
 public:
  LidarStage(Rings& rings, lidar::VisualLidarOdometer odometer, const SensorDelays& delays);

  void run(runtime::DataClock& clock, Time begin, const std::stop_token& stop) override;
  std::size_t saved_bytes() const override;
  std::vector<UseWatch*> uses() override { return {&use_}; }
  std::vector<RefusalCount> refusals() override { return counts_.of(spec().name); }

  // Before run(). At most `points` of each scan.
  void show_to(AskedScan& preview, std::size_t points) {
    preview_ = &preview;
    preview_points_ = points;
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
  void resend();
  void save_until(Time t);
  void forget_sent(Time t);
  void load(ArchiveReader& ar) override { archive(ar); }
  template <class Archive>
  void archive(Archive& ar);

  lidar::VisualLidarOdometer odometer_;
  Duration patience_;
  Outputs<LidarMotion> lidar_;
  Outputs<RelativeMotion> odometry_;
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
  AskedScan* preview_ = nullptr;  // nullptr: no preview is made
  std::size_t preview_points_ = 0;
  ReasonCounts<OdometryStatus, count_of<OdometryStatus>> counts_;  // of the scans
};

}  // namespace maploop::vehicle
