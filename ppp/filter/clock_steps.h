// Handles the whole milliseconds by which a receiver steps its clock to keep it near GPS time.
#pragma once

#include <optional>
#include <vector>

#include "ppp/filter/measurement.h"

namespace maploop::ppp {

// A step of one millisecond changes code or phase by this range, m.
inline constexpr double millisecond_range = 1e-3 * speed_of_light;

// If the codes step and the phases do not, every ambiguity would have to restart. To avoid that,
// the phases get the steps of the codes. If both step, only the clock estimate changes, and the
// phases need no repair.
class ClockSteps {
 public:
  ClockSteps() : code_minus_phase_(satellite_slots) {}

  // Takes the measurements of the next epoch and adds all steps so far to their phases. A satellite
  // whose code and phase have come apart otherwise has lost lock: its phase has begun anew, or has
  // missed a step that too few satellites told.
  void repair(std::vector<Measurement>& measurements);

  template <class Archive>
  void archive(Archive& ar) {
    ar(code_minus_phase_, steps_);
    if constexpr (Archive::loading) {
      if (code_minus_phase_.size() != satellite_slots)
        ar.fail("not the state of a receiver's clock");
    }
  }

 private:
  int new_step(const std::vector<Measurement>& measurements);

  // The values are in m, for the first carrier at the satellite's last epoch, by slot. The phases
  // contain the steps until then, so that a satellite that has missed a step does not tell it
  // again.
  std::vector<std::optional<double>> code_minus_phase_;
  std::vector<double> votes_;  // a member only to reuse its memory
  std::int64_t steps_ = 0;     // ms
};

}  // namespace maploop::ppp
