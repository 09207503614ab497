#include "mapmatch/visual_course.h"

#include <cmath>

#include "msgs/frames.h"

namespace maploop::mapmatch {
namespace {

constexpr double oldest = 0.3;  // s, three images, of which one may be late

}  // namespace

void VisualCourse::add(const RelativeMotion& motion) {
  const double interval = to_seconds(motion.stamp - motion.from);
  if (motion.status != OdometryStatus::ok || !(interval > 0.0)) {
    known_ = false;
    return;
  }
  if (!known_ || motion.from != stamp_) begun_anew_ = true;
  const Eigen::Vector3d forward = motion.rotation * Eigen::Vector3d::UnitX();
  const double turn = -std::atan2(forward.y(), forward.x());  // positive to the right
  known_ = true;
  stamp_ = motion.stamp;
  speed_ = motion.translation.x() / interval;
  azimuth_ = wrap_angle(azimuth_ + turn);
  rate_ = turn / interval;
}

void VisualCourse::describe(VehicleFix& fix) {
  fix.visual_speed = fix.visual_azimuth = unknown;
  const double age = to_seconds(fix.stamp - stamp_);
  if (!known_ || std::abs(age) > oldest) return;
  fix.visual_speed = speed_;
  if (!begun_anew_) fix.visual_azimuth = wrap_angle(azimuth_ + rate_ * age);
  begun_anew_ = false;
}

}  // namespace maploop::mapmatch
