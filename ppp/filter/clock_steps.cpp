#include "ppp/filter/clock_steps.h"

#include <algorithm>
#include <cmath>

#include "msgs/median.h"

namespace maploop::ppp {
namespace {

constexpr double max_step = 1e6;        // ms; a larger change is not a step of a clock
constexpr double largest_noise = 1e-3;  // ms, 300 m: codes and motion change by less

}  // namespace

// Returns the step of the codes against the phases, in ms; zero unless two thirds of the satellites
// agree.
int ClockSteps::step_of_all(const std::vector<Measurement>& measurements) {
  votes_.clear();
  for (const Measurement& m : measurements) {
    if (m.first.phase == 0.0) continue;
    const double now = m.first.code - m.first.phase;
    auto& before = code_minus_phase_[m.satellite.slot()];
    const double step = (now - before.value_or(now)) / millisecond_range;
    if (before && std::abs(step) < max_step) votes_.push_back(step);
    before = now;
  }
  if (votes_.size() < 2) return 0;
  const double whole = std::round(median(votes_));
  const auto agree = std::count_if(votes_.begin(), votes_.end(), [&](double step) {
    return std::abs(step - whole) < largest_noise;
  });
  return 3 * agree >= 2 * static_cast<std::ptrdiff_t>(votes_.size()) ? static_cast<int>(whole) : 0;
}

void ClockSteps::repair(std::vector<Measurement>& measurements) {
  steps_ += step_of_all(measurements);
  if (steps_ == 0) return;
  for (Measurement& m : measurements) {
    for (Carrier* c : {&m.first, &m.second}) {
      if (c->phase != 0.0) c->phase += static_cast<double>(steps_) * millisecond_range;
    }
  }
}

}  // namespace maploop::ppp
