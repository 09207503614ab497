// Watches what the fusion's aids contradict lastingly, and says so of each sensor in HEALTH.
#pragma once

#include <vector>

#include "estimators/fusion/reduced_imu_filter.h"
#include "runtime/vehicle/health/episodes.h"

namespace maploop::vehicle {

class AidDoubts {
 public:
  // The filter must outlive it.
  explicit AidDoubts(const fusion::ReducedImuFilter& filter);

  // Each looks for lasting contradictions after what it names has been added to the filter.
  void judge_fix(Time available);
  void judge_wheel(Time available);
  void judge_motion(Time available);

  // Returns whether the last fixes, or any other aid that was there lately, contradict the others.
  bool any(Time t) const;

  // Those of each sensor.
  std::vector<UseWatch*> watches() { return {&imu_, &gnss_, &wheel_, &odometry_}; }

  void archive(auto& ar) { ar(others_agree_); }

 private:
  const char* doubt_of(fusion::Witness witness, int components) const;

  const fusion::ReducedImuFilter& filter_;
  UseWatch imu_, gnss_, wheel_, odometry_;
  bool others_agree_ = true;  // odometry and the inertial unit
};

}  // namespace maploop::vehicle
