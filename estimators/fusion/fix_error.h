// The error of a fix's position, split into what lasts from fix to fix and what does not.
#pragma once

#include <Eigen/Core>

#include "estimators/fusion/fusion_parameters.h"

namespace maploop::fusion {

// error = lasting o + fresh noise: o is the state's offset, of variance 1 an axis. The whole
// covariance is shared out, correlations too: taking the lasting variances alone from a strongly
// correlated covariance would leave one that is not positive.
struct FixError {
  Eigen::Matrix3d lasting;  // m, symmetric root of gnss_correlated times the covariance
  Eigen::Matrix3d fresh;    // m^2, covariance of the rest
};

// Eigenvalues below zero, which rounding leaves, are taken for zero.
FixError split_error(const Eigen::Matrix3d& position_covariance,
                     const FusionParameters& parameters);

}  // namespace maploop::fusion
