// The measurements of one epoch, linearized about the state: code, phase and Doppler of each
// satellite as rows of a Kalman update.
#pragma once

#include <cstddef>
#include <vector>

#include "ppp/filter/filter_state.h"
#include "ppp/filter/full_strength.h"
#include "ppp/filter/linear_row.h"
#include "ppp/filter/parameters.h"
#include "ppp/filter/range_model.h"
#include "ppp/filter/solution.h"

namespace maploop::ppp {

// A satellite of this epoch.
struct Tracked {
  Measurement measurement;
  PredictedRange predicted;
  std::size_t report;          // its place among the solution's satellites
  double code_offset;          // m, code minus what is predicted without clocks
  double code_repeats = 1.0;   // of its variance, for its error lasts longer than an epoch
  double level = 1.0;          // of all its variances, where its codes' residuals are large
  double level_repeats = 1.0;  // of what that adds to the code's
  bool code_good = true;
  bool phase_good = true;
};

// m^2, of a range: by errors of orbit, clock and ionosphere.
inline double lasting_variance(const PredictedRange& p) {
  return p.satellite.sigma * p.satellite.sigma + p.ionosphere.sigma * p.ionosphere.sigma;
}

enum class RowKind { code, phase, doppler };

// An error that lasts says less than its size: the variance is the one that independent errors
// would need, epoch for epoch, to say as little; sigma is the size.
struct Row : LinearRow {
  RowKind kind = RowKind::code;
  std::size_t tracked = 0;  // whose
  double sigma = 0.0;
  bool active = true;
  bool new_ambiguity = false;  // of a phase: it says nothing yet
  bool doubtful = false;       // not active, but others may be wrong instead
};

class EpochRows {
 public:
  explicit EpochRows(const PppParameters& parameters) : parameters_(parameters) {}

  // Gives each new satellite its ambiguity, and the clock drift its first value; a satellite that
  // finds no room says so in its report. Rows are valid until the next call.
  std::vector<Row>& make(const std::vector<Tracked>& tracked, int reference_system,
                         const FullStrength& strength, FilterState& state,
                         std::vector<SatelliteReport>& reports);

 private:
  // `factor` is of the satellite's variances, against the zenith.
  Row code_row(std::size_t i, const Tracked& t, double factor, int reference_system,
               const FilterState& state) const;
  void add_phase_row(const Tracked& t, double factor, const Row& code, FilterState& state,
                     std::vector<SatelliteReport>& reports);
  void set_drift(const std::vector<Tracked>& tracked, FilterState& state);

  PppParameters parameters_;
  std::vector<Row> rows_;
  std::vector<double> drifts_;  // m/s, that each Doppler says; to reuse its memory
};

}  // namespace maploop::ppp
