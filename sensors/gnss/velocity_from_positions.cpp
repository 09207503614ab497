#include "sensors/gnss/velocity_from_positions.h"

#include "msgs/local_frame.h"

namespace maploop::sensors {

void VelocityFromPositions::set_unknown(GnssFix& fix) {
  constexpr double unknown = 100.0;  // m/s
  fix.velocity_stamp = fix.stamp;
  fix.velocity_enu.setZero();
  fix.velocity_covariance = unknown * unknown * Eigen::Matrix3d::Identity();
}

void VelocityFromPositions::set_velocity(GnssFix& fix) {
  constexpr Duration step = std::chrono::milliseconds(900), longest = std::chrono::seconds(4);
  set_unknown(fix);
  if (!earlier_.empty() && fix.stamp - earlier_.front().stamp < step) return;
  if (earlier_.size() == 2) {
    const Eigen::Vector3d a = LocalFrame(fix.position).to_enu(earlier_[0].position);
    const Eigen::Vector3d b = LocalFrame(fix.position).to_enu(earlier_[1].position);
    const double t = to_seconds(fix.stamp - earlier_[0].stamp);
    const double u = to_seconds(fix.stamp - earlier_[1].stamp);
    const double of_a = u / (t * (u - t)), of_b = t / (u * (u - t));
    if (fix.stamp - earlier_[1].stamp <= longest) {
      fix.velocity_enu = of_b * b - of_a * a;
      constexpr double noise = 0.2;  // m, of a fix against those of the seconds before it
      const double sigma = noise * Eigen::Vector3d(1.0 / t + 1.0 / u, of_a, of_b).norm();
      fix.velocity_covariance = sigma * sigma * Eigen::Matrix3d::Identity();
    }
    earlier_.pop_back();
  }
  earlier_.push_front({fix.stamp, fix.position});
}

}  // namespace maploop::sensors
