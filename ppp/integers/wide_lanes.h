// Estimates the wide-lane ambiguity of each satellite, the difference of the ambiguities of its two
// carriers, from codes and phases alone (Melbourne-Wuebbena).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "ppp/filter/satellite_tracker.h"

namespace maploop::ppp {

// An ambiguity that can be an integer.
struct IntegerCandidate {
  Satellite satellite;
  std::size_t tracked = 0;  // index into the epoch's tracked satellites
  // The ionosphere-free ambiguity is the sum of that of the range and of that of the ionosphere, at
  // these indices of the filter's state, by these weights.
  std::array<int, 2> indices{};
  std::array<double, 2> weights{};
  double length = 0.0;        // m, of the narrow lane: an integer's effect on the ambiguity
  double wide_factor = 0.0;   // narrow lanes for each wide lane
  double wide_lane = 0.0;     // cycles, apart from a number that a system's satellites share
  bool resolved = false;      // the wide lane is known
  std::size_t reference = 0;  // the candidate of its system that it is differenced against
  std::optional<double> own;  // its integer, narrow lanes beyond those of the reference
};

class WideLanes {
 public:
  WideLanes() : means_(satellite_slots) {}
  void reset() { means_.assign(satellite_slots, {}); }
  // Its ambiguity has restarted.
  void restart(Satellite satellite) { means_[satellite.slot()] = {}; }

  // Adds one epoch of a satellite, whose measurement has two carriers; `code_variance` is that of
  // the code of one carrier, m^2, and `inflation` the factor on it because its error lasts for
  // several epochs.
  void add(const Measurement& m, double code_variance, double inflation);

  // Resolves the wide lanes of one system's satellites, of which the receiver's bias is unknown.
  void resolve(std::span<IntegerCandidate> of_one_system, double largest_sigma,
               double largest_fraction) const;

  template <class Archive>
  void archive(Archive& ar) {
    ar(means_);
  }

 private:
  struct Mean {
    double cycles = 0.0, weight = 0.0;  // weight: cycles^-2, by the assumed noise of codes
    double squares = 0.0;               // of the deviations, relative to that noise
    double samples = 0.0;               // as many independent ones would be worth

    // The variance by the noise that was measured, cycles^2.
    double variance() const;

    template <class Archive>
    void archive(Archive& ar) {
      ar(cycles, weight, squares, samples);
    }
  };
  std::vector<Mean> means_;  // by Satellite::slot()
};

}  // namespace maploop::ppp
