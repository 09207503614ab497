// What is used of a satellite's signals: two carriers, or one.
#pragma once

#include <array>
#include <optional>

#include "ppp/observations.h"
#include "ppp/products/ephemeris.h"

namespace maploop::ppp {

struct Carrier {
  char band = 0, attribute = 0;  // of the code
  double frequency = 0.0;        // Hz
  double wavelength = 0.0;       // m
  double code = 0.0;             // m, biases removed; 0: none
  double phase = 0.0;            // m; 0: none
  double doppler = 0.0;          // Hz
  double cn0 = 0.0;              // dB-Hz; 0: not said
  bool lost_lock = false;
};

struct Measurement {
  Satellite satellite;
  Carrier first, second;  // second.frequency 0: one frequency

  bool dual() const { return second.frequency > 0.0; }
  // Weights of the ionosphere-free combination.
  double weight1() const;
  double weight2() const;
  double code() const;          // ionosphere-free, or the first carrier's
  double phase() const;         // the same
  double noise_factor() const;  // of the combination
};

// The bands of a system's ionosphere-free pair, as products mean it.
std::array<char, 2> bands_of(System system);

// Picks code and phase of each band. With one frequency, or where the second is missing and
// `allow_single`, the second carrier is empty. Nothing: no usable code and phase.
std::optional<Measurement> measure(Satellite satellite, std::span<const Signal> signals,
                                   const std::array<std::optional<int>, 100>& glonass_channels,
                                   const Ephemeris& ephemeris, GpsTime t, bool allow_single);

}  // namespace maploop::ppp
