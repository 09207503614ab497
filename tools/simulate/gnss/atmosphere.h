// Simulates the delays of GNSS signals in the troposphere and ionosphere at one place.
#pragma once

#include <cstdint>
#include <vector>

#include "msgs/local_frame.h"

namespace maploop::simulate {

// A standard atmosphere with the day's pressure, temperature and humidity, through which rays are
// traced layer by layer (Snell's law in spheres) instead of using a mapping function. In addition,
// the wet delay changes by some per cent over half an hour, and there is a horizontal gradient.
class Troposphere {
 public:
  Troposphere(double height, std::uint64_t seed);  // m above the sea

  // Returns m; angles are in rad, t in s since the drive's start.
  double delay(double elevation, double azimuth, double t) const;
  double zenith_delay(double t) const { return delay(1.5707, 0.0, t); }

 private:
  struct Row {
    double elevation, all, wet;  // rad, m, m
  };
  std::vector<Row> table_;  // in order of elevation
  double wet_number_, wet_phase_, north_, east_;
};

// A shell 450 km high; its electron density follows the sun, and waves travel through it.
class Ionosphere {
 public:
  // `day_start` is the drive's start in seconds of its day or week.
  Ionosphere(const Geodetic& site, double day_start, std::uint64_t seed);

  // Returns the electrons along the signal path, 1e16/m^2; angles are in rad, t in s.
  double electrons(double elevation, double azimuth, double t) const;

 private:
  struct Wave {
    double north, east, rate, phase, size;  // rad/m, rad/m, rad/s, rad, 1e16/m^2
  };
  Geodetic site_;
  double day_start_;
  double level_;
  std::vector<Wave> waves_;
};

// Returns the code delay (which is also the phase advance) in m; `electrons` in 1e16/m^2,
// `frequency` in Hz.
double ionospheric_delay(double electrons, double frequency);

}  // namespace maploop::simulate
