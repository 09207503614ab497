// The stereo thread: visual odometry at each image pair.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include "estimators/stereo/stereo_odometry.h"
#include "msgs/image.h"
#include "msgs/visual_motion.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/episodes.h"
#include "runtime/vehicle/fault_delay.h"
#include "runtime/vehicle/preview_stage.h"
#include "runtime/vehicle/stage_cuts.h"
#include "runtime/vehicle/thread_meter.h"
#include "runtime/vehicle/watchdog.h"

namespace maploop::vehicle {

// Sends each motion to all `outputs`, and with its disparities to `lidar` (null: there is none).
class StereoStage {
 public:
  StereoStage(stereo::StereoOdometry odometry, runtime::Edge<StereoPair>& images,
              const runtime::Doorbell& bell, std::vector<runtime::Edge<RelativeMotion>*> outputs,
              runtime::Edge<VisualMotion>* lidar);

  // Until the images are finished or stop is requested.
  void run(const runtime::DataClock& clock, const std::stop_token& stop);
  // Instead of it, where the odometry is recorded: no result of its own, and no state that changes.
  void idle(const std::stop_token& stop);
  void finish();

  // Before run().
  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }
  void show_to(AskedImage& preview) { preview_ = &preview; }
  void slow_down(StageDelay delay) { delay_ = std::move(delay); }
  void save_at(std::vector<Time> moments, runtime::Edge<StageSnapshot>& edge) {
    cuts_.set(std::move(moments), edge);
  }
  // Memory that what it saves takes at most.
  std::size_t saved_bytes() const {
    return odometry_.largest_archive() + 4 * sizeof(VisualMotion) + 4096;
  }
  // Goes on from what was saved; throws ArchiveError, as StereoOdometry.
  void resume(std::span<const std::uint8_t> saved);

  const ThreadMeter& meter() const { return meter_; }
  UseWatch& use() { return use_; }
  // Results so far with this status; any thread may ask.
  std::uint64_t count(OdometryStatus status) const {
    return counts_[static_cast<std::size_t>(status)].load(std::memory_order_relaxed);
  }

 private:
  void process(const StereoPair& pair, const std::stop_token& stop);
  void show(const StereoPair& pair);
  void send(VisualMotion& motion, const std::stop_token& stop);
  void save_until(Time t, const std::stop_token& stop);
  template <class Archive, class Stage>
  static void describe(Archive& ar, Stage& stage);
  void promise(Time t);

  stereo::StereoOdometry odometry_;
  runtime::Edge<StereoPair>& images_;
  const runtime::Doorbell& bell_;
  std::vector<runtime::Edge<RelativeMotion>*> outputs_;
  runtime::Edge<VisualMotion>* lidar_;
  UseWatch use_{stages::stereo.name, "image pairs", Watchdog::patience(stages::stereo)};
  ThreadMeter meter_;
  runtime::TraceBuffer* trace_ = nullptr;
  AskedImage* preview_ = nullptr;  // nullptr: nobody looks on
  StageDelay delay_;
  StageCuts cuts_;
  std::vector<VisualMotion> sent_;  // those that were not yet available at the last pair
  std::array<std::atomic<std::uint64_t>, odometry_status_count> counts_{};
};

}  // namespace maploop::vehicle
