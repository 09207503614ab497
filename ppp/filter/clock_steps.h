// Milliseconds by which a receiver's clock steps, so that it keeps near to GPS time.
#pragma once

#include <optional>
#include <vector>

#include "ppp/filter/measurement.h"

namespace maploop::ppp {

// How far a millisecond's step moves code or phase, m.
inline constexpr double millisecond_range = 1e-3 * speed_of_light;

// Where codes step and phases do not, every ambiguity would begin anew: phases are given the
// codes' steps. A step of both is the receiver's clock, which no phase is asked to keep.
class ClockSteps {
 public:
  ClockSteps() : code_minus_phase_(satellite_slots) {}

  // Of the next epoch; adds the steps so far to all its phases.
  void repair(std::vector<Measurement>& measurements);

  template <class Archive>
  void archive(Archive& ar) {
    ar(code_minus_phase_, steps_);
    if constexpr (Archive::loading) {
      if (code_minus_phase_.size() != satellite_slots) ar.fail("no receiver's clock");
    }
  }

 private:
  int step_of_all(const std::vector<Measurement>& measurements);

  // m, of the first carrier at its last epoch, by slot.
  std::vector<std::optional<double>> code_minus_phase_;
  std::vector<double> votes_;  // to reuse its memory
  std::int64_t steps_ = 0;     // ms
};

}  // namespace maploop::ppp
