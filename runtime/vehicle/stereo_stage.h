// The stereo thread: visual odometry at each image pair.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <utility>

#include "estimators/stereo/stereo_odometry.h"
#include "msgs/image.h"
#include "msgs/odometry.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/core/trace_span.h"
#include "runtime/vehicle/fault_delay.h"
#include "runtime/vehicle/thread_meter.h"

namespace maploop::vehicle {

class StereoStage {
 public:
  StereoStage(stereo::StereoOdometry odometry, runtime::Edge<StereoPair>& images,
              const runtime::Doorbell& bell, runtime::Edge<RelativeMotion>& to_fusion,
              runtime::Edge<RelativeMotion>& to_publisher);

  // Until the images are finished or stop is requested.
  void run(const runtime::DataClock& clock, const std::stop_token& stop);
  void finish();

  void trace_to(runtime::TraceBuffer* buffer) { trace_ = buffer; }  // before run()
  void slow_down(StageDelay delay) { delay_ = std::move(delay); }   // before run()

  const ThreadMeter& meter() const { return meter_; }
  // Results so far with this status; any thread may ask.
  std::uint64_t count(OdometryStatus status) const {
    return counts_[static_cast<std::size_t>(status)].load(std::memory_order_relaxed);
  }

 private:
  void process(const StereoPair& pair, const std::stop_token& stop);
  void promise(Time t);

  stereo::StereoOdometry odometry_;
  runtime::Edge<StereoPair>& images_;
  const runtime::Doorbell& bell_;
  runtime::Edge<RelativeMotion>& to_fusion_;
  runtime::Edge<RelativeMotion>& to_publisher_;
  ThreadMeter meter_;
  runtime::TraceBuffer* trace_ = nullptr;
  StageDelay delay_;
  std::array<std::atomic<std::uint64_t>, odometry_status_count> counts_{};
};

}  // namespace maploop::vehicle
