// Computes the ionospheric delay on one frequency from the coefficients that satellites broadcast.
#pragma once

#include "msgs/local_frame.h"
#include "ppp/readers/streams/ionosphere_message.h"

namespace maploop::ppp {

// Returns the delay in m on GPS L1 (1575.42 MHz); on another frequency it is larger by the squared
// ratio of the frequencies. GPS's coefficients belong to Klobuchar's model, Galileo's ionisation
// level to NTCM-G ("NTCM-G Ionospheric Model Description", European Commission, 1.0, 2022).
// `azimuth` and `elevation` are in rad; `elevation` is above 0.
double ionospheric_delay(const IonosphereCoefficients& coefficients, const Geodetic& site,
                         double azimuth, double elevation, GpsTime t);

// A PiercePoint is where a ray crosses a thin shell at 450 km above the earth, rad.
struct PiercePoint {
  double latitude = 0.0, longitude = 0.0;
};
PiercePoint pierce_point(const Geodetic& site, double azimuth, double elevation);

// One TECU, 10^16 electrons per square metre, delays GPS L1 by this, m.
inline constexpr double delay_of_electrons = 40.3e16 / (1575.42e6 * 1575.42e6);

// Returns how far from the receiver the signal crosses that shell, 1000 km along the ground.
double ionospheric_distance(double elevation);

// Returns the slant delay relative to the vertical one, for that shell as in NTCM-G.
double ionospheric_slant(double elevation);

}  // namespace maploop::ppp
