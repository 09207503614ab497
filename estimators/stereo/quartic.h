// This header computes the real roots of a quartic.
#pragma once

#include <array>

namespace maploop::stereo {

struct QuarticRoots {
  int count = 0;
  std::array<double, 4> value{};
};

// Returns the real roots of c[0] x^4 + c[1] x^3 + c[2] x^2 + c[3] x + c[4]; a double root may be
// returned twice. Uses Ferrari's solution, refined by Newton's method. Returns no roots if c[0] is
// negligible against the other coefficients.
QuarticRoots solve_quartic(const std::array<double, 5>& c);

}  // namespace maploop::stereo
