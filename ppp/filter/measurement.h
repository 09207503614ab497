// Selects which of a satellite's signals are used: those of two carriers, or of one.
#pragma once

#include <array>
#include <optional>

#include "ppp/observations.h"
#include "ppp/products/ephemeris.h"

namespace maploop::ppp {

// Three coordinates and the clock: a position needs as many ranges.
inline constexpr int position_unknowns = 4;

struct Carrier {
  char band = 0, attribute = 0;  // those of the code
  double frequency = 0.0;        // Hz
  double wavelength = 0.0;       // m
  double code = 0.0;             // m, biases removed; 0: not measured
  double phase = 0.0;            // m; 0: not measured
  double doppler = 0.0;          // Hz
  double cn0 = 0.0;              // dB-Hz; 0: not given
  bool lost_lock = false;
  char phase_attribute = 0;  // of the phase, which may be of another signal than the code
};

// Returns the ionosphere's delay of a carrier's code relative to that on GPS L1.
double ionosphere_factor(const Carrier& carrier);

// These are the two quantities that a satellite's carriers measure. The mean of both carriers, or
// the only one, measures the range. Half the difference of the second and the first carrier
// measures the ionosphere. If both carriers are equally noisy, the noise of mean and difference is
// uncorrelated, and what is the same on both, such as the detour of a reflected signal, is in the
// mean alone.
enum class Combination : std::uint8_t { range, ionosphere };

struct Measurement {
  Satellite satellite;
  Carrier first, second;   // second.frequency is 0 with one frequency
  bool integer = false;    // the biases of both phases are removed: their ambiguities are integers
  std::size_t report = 0;  // index into the epoch's reports

  bool dual() const { return second.frequency > 0.0; }
  std::size_t carriers() const { return dual() ? 2 : 1; }
  const Carrier& carrier(std::size_t k) const { return k == 0 ? first : second; }
  // Returns the weights of both carriers in a combination.
  std::array<double, 2> weights(Combination c) const;
  double code(Combination c) const;  // m
  bool has_phase() const { return first.phase != 0.0 && (!dual() || second.phase != 0.0); }
  double phase(Combination c) const;  // m; only with has_phase()
  // Returns the ionosphere's delay of the combined code, relative to that on GPS L1.
  double ionosphere(Combination c) const;
  // Returns the weight of Combination::ionosphere that, added to the range, removes the ionosphere.
  double ionosphere_free_weight() const;
  // Returns the standard deviation of a combination, of which each carrier has an error of its own
  // (`own`) and both have one in common.
  double sigma(Combination c, double own, double common) const;
  // These are Melbourne's and Wuebbena's combination of two carriers' codes and phases, m, and the
  // length of its cycle, the wide lane.
  double wide_lane() const;
  double wide_lane_length() const;
};

// Selects code and phase of each band. The second carrier is empty if its code is missing.
// Returns nothing if the first has no code or no known frequency; its phase may be missing.
std::optional<Measurement> measure(Satellite satellite, std::span<const Signal> signals,
                                   const std::array<std::optional<int>, 100>& glonass_channels,
                                   const Ephemeris& ephemeris, GpsTime t);

}  // namespace maploop::ppp
