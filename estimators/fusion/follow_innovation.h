// Adds an innovation to the statistics of lasting contradictions.
#pragma once

#include <Eigen/Cholesky>
#include <cmath>

#include "estimators/fusion/fusion_parameters.h"
#include "estimators/fusion/joseph_update.h"

namespace maploop::fusion {

// Adds the first row of an innovation, or the first two of a fix's (east and north), as they are
// before the correction.
template <int rows>
void follow(FilterState& state, Witness witness, const Innovation<rows>& innovation,
            const FusionParameters& p) {
  Eigen::Vector2d whitened = Eigen::Vector2d::Zero();
  if constexpr (rows == 1) {
    whitened[0] = innovation.residual[0] / std::sqrt(innovation.covariance(state.P)(0, 0));
  } else {
    const Innovation<2> two = innovation.template part<2>(0);
    whitened = two.covariance(state.P).llt().matrixL().solve(two.residual);
  }
  if (!whitened.allFinite()) return;
  state.contradictions.of(witness).add(whitened, state.stamp, p.doubt_memory);
}

}  // namespace maploop::fusion
