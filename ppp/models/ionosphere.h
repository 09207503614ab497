// The ionosphere's delay on one frequency, by the coefficients that satellites broadcast.
#pragma once

#include "msgs/local_frame.h"
#include "ppp/readers/ionosphere_message.h"

namespace maploop::ppp {

// m on GPS L1 (1575.42 MHz); others have it by the square of the frequencies' ratio. Galileo's
// level drives NTCM-G ("NTCM-G Ionospheric Model Description", European Commission, 1.0, 2022).
// `elevation` is above 0; rad.
double ionospheric_delay(const IonosphereCoefficients& coefficients, const Geodetic& site,
                         double azimuth, double elevation, GpsTime t);

// Of a thin shell at 450 km, against the zenith; as NTCM-G has it.
double ionospheric_slant(double elevation);

}  // namespace maploop::ppp
