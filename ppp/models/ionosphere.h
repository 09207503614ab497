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

// Returns how far from the receiver the signal crosses that shell, 1000 km along the ground.
double ionospheric_distance(double elevation);

// Returns the slant delay relative to the vertical one, for a thin shell at 450 km as in NTCM-G.
double ionospheric_slant(double elevation);

}  // namespace maploop::ppp
