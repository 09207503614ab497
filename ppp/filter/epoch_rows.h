// Linearizes the measurements of one epoch about the state: code, phase and Doppler of each
// satellite become rows of a Kalman update.
#pragma once

#include <cstddef>
#include <vector>

#include "ppp/filter/filter_state.h"
#include "ppp/filter/linear_row.h"
#include "ppp/filter/satellite_tracker.h"
#include "ppp/filter/unobstructed_cn0.h"

namespace maploop::ppp {

enum class RowKind { code, phase, doppler };

// An error that lasts for several epochs carries less information than its size suggests.
// `variance` is inflated so that independent errors of that variance would carry the same
// information epoch by epoch; `sigma` is the actual size of the error.
struct Row : LinearRow {
  RowKind kind = RowKind::code;
  std::size_t tracked = 0;  // index into the epoch's tracked satellites
  Combination combination = Combination::range;
  double sigma = 0.0;
  double most_sigmas = 0.0;  // beyond so many of them its residual is an outlier
  double delay = 0.0;        // m, by which y has been shortened, because a reflection is expected
  bool active = true;
  bool new_ambiguity = false;  // on a phase: its ambiguity is new, so it carries no information yet
  bool doubtful = false;       // it is not active, but other phases may be the wrong ones instead
};

// Returns the ionosphere's delay on GPS L1 that the state gives a satellite, m.
double ionosphere_of(const Tracked& t, const FilterState& state);

class EpochRows {
 public:
  explicit EpochRows(const PppParameters& parameters) : parameters_(parameters) {}

  // Adds an ambiguity for each new satellite and sets the first value of the clock drift. If the
  // state has no room for a satellite, its report states so. The rows are valid until the next
  // call.
  std::vector<Row>& make(const std::vector<Tracked>& tracked, int reference_system,
                         const UnobstructedCn0& strength, FilterState& state,
                         std::vector<SatelliteReport>& reports);
  const std::vector<Row>& rows() const { return rows_; }

 private:
  // `factor` scales the satellite's variances relative to the zenith.
  Row range_row(std::size_t i, const Tracked& t, Combination c, double sign, int reference_system,
                const FilterState& state) const;
  Row code_row(std::size_t i, const Tracked& t, Combination c, double factor, double missing,
               int reference_system, FilterState& state) const;
  double most_sigmas(double missing) const;
  Row doppler_row(std::size_t i, const Tracked& t, double factor, double missing,
                  const FilterState& state) const;
  void add_phase_row(std::size_t i, const Tracked& t, Combination c, double factor, double missing,
                     int reference_system, FilterState& state,
                     std::vector<SatelliteReport>& reports);
  void set_drift(const std::vector<Tracked>& tracked, FilterState& state);

  PppParameters parameters_;
  std::vector<Row> rows_;
  std::vector<double> drifts_;  // m/s, of each Doppler; a member only to reuse its memory
};

}  // namespace maploop::ppp
