// Draws random vectors that are the same on every processor.
#pragma once

#include <Eigen/Core>

namespace maploop::testing {

// Returns a vector whose elements are draw(), the last one first. The order in which the arguments
// of a constructor are evaluated is not specified: on aarch64 it is another one than on x86-64.
template <class Vector, class Draw>
Vector drawn(const Draw& draw) {
  Vector vector;
  for (Eigen::Index i = vector.size(); i-- > 0;) vector[i] = draw();
  return vector;
}

}  // namespace maploop::testing
