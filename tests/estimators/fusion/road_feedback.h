// This file makes feedback of made-up roads, and a filter that can take it at once.
#pragma once

#include "estimators/fusion/reduced_imu_filter.h"
#include "tests/estimators/fusion/filter_run.h"
#include "tests/estimators/fusion/synthetic_drive.h"

namespace maploop::testing {

// Returns a straight road to the north near a place, whose line is `right` metres to the right of
// it.
inline MapFeedback road(const LocalFrame& frame, const Eigen::Vector2d& place, double right = 0.0) {
  MapFeedback f;
  f.reason = FeedbackReason::none;
  f.position = f.azimuth = true;
  f.point = frame.to_geodetic({place.x() + right, place.y(), 0.0});
  f.cross_sigma = 1.0;
  f.lane_sigma = 2.0;
  f.azimuth_sigma = 0.03;
  return f;
}

// Returns a filter that knows the start of the synthetic drives.
inline fusion::ReducedImuFilter started_filter(
    const fusion::FusionParameters& p = configured("RISS")) {
  fusion::ReducedImuFilter filter(p, test_origin());
  fusion::KnownStart start;
  start.stamp = SyntheticDrive::at(0.0);
  start.position = test_origin();
  start.speed = 10.0;
  filter.start(start);
  return filter;
}

}  // namespace maploop::testing
