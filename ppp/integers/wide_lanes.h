// Measures the wide-lane ambiguity of each satellite, the difference of the ambiguities of its two
// carriers, by codes and phases alone (Melbourne-Wuebbena).
#pragma once

#include <optional>
#include <vector>

#include "ppp/filter/measurement.h"

namespace maploop::ppp {

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

  struct Mean {
    double cycles = 0.0, weight = 0.0;  // weight: cycles^-2, by the assumed noise of codes
    double squares = 0.0;               // of the deviations, relative to that noise
    double samples = 0.0;               // as many independent ones would be worth

    // Returns the variance by the noise that was measured, cycles^2.
    double variance() const;

    template <class Archive>
    void archive(Archive& ar) {
      ar(cycles, weight, squares, samples);
    }
  };
  // Returns a satellite's mean, to which the receiver adds a bias of the satellite's system; its
  // weight is 0 without an epoch.
  const Mean& of(Satellite satellite) const { return means_[satellite.slot()]; }

  template <class Archive>
  void archive(Archive& ar) {
    ar(means_);
  }

 private:
  std::vector<Mean> means_;  // by Satellite::slot()
};

}  // namespace maploop::ppp
