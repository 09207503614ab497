// A fix's position error is split here into a part that lasts from fix to fix and a part that does
// not.
#pragma once

#include <Eigen/Core>

#include "estimators/fusion/fusion_parameters.h"

namespace maploop::fusion {

// The model is error = lasting * o + fresh noise, where o is the state's offset with variance 1 on
// each axis. The whole covariance is split, correlations included: subtracting only the lasting
// variances from a strongly correlated covariance would leave a matrix that is not positive.
struct FixError {
  Eigen::Matrix3d lasting;  // m, symmetric root of gnss_correlated times the covariance
  Eigen::Matrix3d fresh;    // m^2, covariance of the remaining error
};

// Takes the position covariance of a fix in m^2, enu. Negative eigenvalues, which rounding causes,
// are set to zero.
FixError split_error(const Eigen::Matrix3d& position_covariance,
                     const FusionParameters& parameters);

}  // namespace maploop::fusion
