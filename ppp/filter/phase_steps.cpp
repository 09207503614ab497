#include "ppp/filter/phase_steps.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace maploop::ppp {
namespace {

constexpr int step_unknowns = 4;  // the displacement, and the step of the clock
using Vector = Eigen::Matrix<double, step_unknowns, 1>;

Vector design(const PhaseStep& s) {
  return {-s.to_satellite.x(), -s.to_satellite.y(), -s.to_satellite.z(), 1.0};
}

// Returns the residual in units of the limit.
double misfit(const PhaseStep& s, const Vector& x) {
  return std::abs(s.change - design(s).dot(x)) / s.limit;  // (20) of METHOD.md
}

// Weights are in units of the inverse squared limits.
template <class Weight>
Vector fit(const std::vector<PhaseStep>& steps, Weight&& weight) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Vector right = Vector::Zero();
  for (const PhaseStep& s : steps) {
    const Vector h = design(s);
    const double w = weight(s) / (s.limit * s.limit);
    normal += w * h * h.transpose();
    right += w * s.change * h;
  }
  return normal.ldlt().solve(right);
}

Vector least_absolute_values(const std::vector<PhaseStep>& steps) {
  constexpr int passes = 30;
  constexpr double small = 0.01;  // of a limit: misfits below about a millimetre count alike
  Vector x = fit(steps, [](const PhaseStep&) { return 1.0; });
  for (int i = 0; i < passes; ++i) {
    x = fit(steps, [&](const PhaseStep& s) { return 1.0 / std::max(small, misfit(s, x)); });
  }
  return x;
}

}  // namespace

void find_slips(std::vector<PhaseStep>& steps) {
  constexpr std::ptrdiff_t fewest = step_unknowns + 1;
  if (static_cast<std::ptrdiff_t>(steps.size()) < fewest) return;
  Vector x = least_absolute_values(steps);
  const auto judge = [&] {
    for (PhaseStep& s : steps) s.slipped = !(misfit(s, x) <= 1.0);
    return std::count_if(steps.begin(), steps.end(), [](const PhaseStep& s) { return !s.slipped; });
  };
  // Repeats the fit with all that agree, because least absolute values follow the noise of the few
  // steps that decide them.
  if (judge() >= fewest) {
    x = fit(steps, [](const PhaseStep& s) { return s.slipped ? 0.0 : 1.0; });
    if (judge() >= fewest) return;
  }
  for (PhaseStep& s : steps) s.slipped = false;
}

}  // namespace maploop::ppp
