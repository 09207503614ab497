// The stereo thread: visual odometry at each image pair.
#pragma once

#include <stop_token>

#include "estimators/stereo/stereo_odometry.h"
#include "msgs/image.h"
#include "msgs/odometry.h"
#include "runtime/core/data_clock.h"
#include "runtime/core/doorbell.h"
#include "runtime/core/edge.h"
#include "runtime/vehicle/meter.h"

namespace maploop::vehicle {

class StereoStage {
 public:
  StereoStage(stereo::StereoOdometry odometry, runtime::Edge<StereoPair>& images,
              const runtime::Doorbell& bell, runtime::Edge<RelativeMotion>& to_fusion,
              runtime::Edge<RelativeMotion>& to_publisher);

  // Until the images are finished or stop is requested.
  void run(const runtime::DataClock& clock, const std::stop_token& stop);
  void finish();

  const Meter& meter() const { return meter_; }

 private:
  void process(const StereoPair& pair, const std::stop_token& stop);
  void promise(Time t);

  stereo::StereoOdometry odometry_;
  runtime::Edge<StereoPair>& images_;
  const runtime::Doorbell& bell_;
  runtime::Edge<RelativeMotion>& to_fusion_;
  runtime::Edge<RelativeMotion>& to_publisher_;
  Meter meter_;
};

}  // namespace maploop::vehicle
