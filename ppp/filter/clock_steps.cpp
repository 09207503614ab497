#include "ppp/filter/clock_steps.h"

#include <algorithm>
#include <cmath>

#include "msgs/median.h"

namespace maploop::ppp {
namespace {

constexpr double max_step = 1e6;        // ms; a larger change is not a step of a clock
constexpr double largest_noise = 1e-3;  // ms, 300 m: codes and motion change by less

void add_to_phases(std::vector<Measurement>& measurements, std::int64_t milliseconds) {
  if (milliseconds == 0) return;
  for (Measurement& m : measurements) {
    for (Carrier* c : {&m.first, &m.second}) {
      if (c->phase != 0.0) c->phase += static_cast<double>(milliseconds) * millisecond_range;
    }
  }
}

}  // namespace

// Returns the step of the codes against the phases since each satellite was last seen, in ms; zero
// unless two satellites or more have one, and two thirds of them agree.
int ClockSteps::new_step(const std::vector<Measurement>& measurements) {
  votes_.clear();
  for (const Measurement& m : measurements) {
    const auto& before = code_minus_phase_[m.satellite.slot()];
    if (m.first.phase == 0.0 || !before) continue;
    const double step = (m.first.code - m.first.phase - *before) / millisecond_range;
    if (std::abs(step) < max_step) votes_.push_back(step);
  }
  if (votes_.size() < 2) return 0;
  const double whole = std::round(median(votes_));
  const auto agree = std::count_if(votes_.begin(), votes_.end(), [&](double step) {
    return std::abs(step - whole) < largest_noise;
  });
  return 3 * agree >= 2 * static_cast<std::ptrdiff_t>(votes_.size()) ? static_cast<int>(whole) : 0;
}

void ClockSteps::repair(std::vector<Measurement>& measurements) {
  add_to_phases(measurements, steps_);
  const int step = new_step(measurements);
  add_to_phases(measurements, step);
  steps_ += step;
  for (Measurement& m : measurements) {
    if (m.first.phase == 0.0) continue;
    const double now = m.first.code - m.first.phase;
    auto& before = code_minus_phase_[m.satellite.slot()];
    if (before && std::abs(now - *before) > largest_noise * millisecond_range)
      m.first.lost_lock = true;
    before = now;
  }
}

}  // namespace maploop::ppp
