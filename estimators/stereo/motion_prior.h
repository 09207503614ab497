// This prior expresses what a vehicle's inertia predicts for its next motion.
#pragma once

#include <Eigen/Geometry>

namespace maploop::stereo {

struct MotionPrior {
  Eigen::Isometry3d T_previous_current = Eigen::Isometry3d::Identity();  // cam, expected
  // These are the standard deviations of the perturbation (residual.h): first m, then rad.
  Eigen::Matrix<double, 6, 1> sigma = Eigen::Matrix<double, 6, 1>::Ones();

  // Returns the perturbation from the expected motion to `pose`, in standard deviations.
  Eigen::Matrix<double, 6, 1> residual(const Eigen::Isometry3d& pose) const {
    const Eigen::AngleAxisd turn(
        Eigen::Matrix3d(pose.linear() * T_previous_current.linear().transpose()));
    Eigen::Matrix<double, 6, 1> r;
    r << pose.translation() - T_previous_current.translation(), turn.angle() * turn.axis();
    return r.cwiseQuotient(sigma);
  }
};

}  // namespace maploop::stereo
