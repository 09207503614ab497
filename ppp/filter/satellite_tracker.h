// Predicts the range of each satellite of an epoch and compares its signals with those of the
// epochs before.
#pragma once

#include <optional>
#include <vector>

#include "ppp/filter/code_levels.h"
#include "ppp/filter/filter_state.h"
#include "ppp/filter/parameters.h"
#include "ppp/filter/phase_steps.h"
#include "ppp/filter/range_model.h"
#include "ppp/filter/slip_detector.h"
#include "ppp/filter/solution.h"

namespace maploop::ppp {

// A Tracked is one satellite of this epoch.
struct Tracked {
  Measurement measurement;
  PredictedRange predicted;
  double code_offset = 0.0;      // m, code minus its prediction without clocks
  double code_inflation = 1.0;   // factor on the code's variance: its error outlasts an epoch
  double phase_inflation = 1.0;  // the same of the error that its phases have in common
  double level = 1.0;            // factor on all variances, if the codes' residuals are large
  bool first_code = true;        // the satellite had none before
  bool code_good = true;
  bool phase_good = true;
  bool new_source = false;  // its orbit and clock come from another source than before
};

class SatelliteTracker {
 public:
  SatelliteTracker() : memory_(satellite_slots) {}
  void reset() { memory_.assign(satellite_slots, {}); }

  // The receiver has lost all phases, also those of satellites that are not measured now.
  void lose_lock() {
    for (Memory& memory : memory_) memory.phase_lost = true;
  }

  // Returns the satellites that have an orbit and are above the mask; they are valid until the next
  // call. The model has begun at time `t`, `interval` s after the last epoch (0 at the first, and
  // negative backward in time). Ambiguities of slipped phases are removed from the state.
  std::vector<Tracked>& track(const std::vector<Measurement>& measured, GpsTime t, double interval,
                              const RangeModel& model, const CodeLevels& levels,
                              const PppParameters& parameters, FilterState& state,
                              std::vector<SatelliteReport>& reports);

  // Removes the ambiguities of satellites that have been missing for longer than `longest_gap`
  // epochs.
  void forget_absent(int longest_gap, FilterState& state) const;

  template <class Archive>
  void archive(Archive& ar) {
    ar(memory_);
    if constexpr (Archive::loading) {
      if (memory_.size() != satellite_slots) ar.fail("not the memory of all satellites");
    }
  }

 private:
  struct Memory {  // one satellite's
    SlipDetector slips;
    bool dual = false;  // the phase was that of two carriers
    double wind_up = 0.0;
    int epochs_away = 0;
    bool phase_lost = false;  // the next phase begins a new ambiguity
    std::optional<GpsTime> last_code;
    std::uint32_t source = 0;  // the source of orbit and clock
    bool integer = false;      // the biases of its phases were known
    std::uint32_t phase_jumps = 0;
    GpsTime message{};            // reference time of their broadcast message
    double phase_less_range{};    // m, at the last epoch with a phase
    IonosphericDelay ionosphere;  // of the model, at the last epoch
    template <class Archive>
    void archive(Archive& ar) {
      ar(slips, dual, wind_up, epochs_away, phase_lost, last_code, source, integer, phase_jumps);
      ar(message, phase_less_range, ionosphere.value, ionosphere.source);
    }
  };
  static void bridge_ionosphere(const Tracked& tracked, Memory& memory, FilterState& state);
  PppSlip look_for_slip(const Tracked& tracked, double interval, const PppParameters& parameters,
                        FilterState& state);
  void pass(double interval, const PppParameters& parameters);

  std::vector<Memory> memory_;
  std::vector<Tracked> tracked_;  // both are members only to reuse their memory
  std::vector<PhaseStep> phase_steps_;
};

}  // namespace maploop::ppp
