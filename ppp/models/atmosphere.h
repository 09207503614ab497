// The air at a place and season, by the climatology of the RTCA's minimum operational performance
// standards (DO-229, appendix A): no measurement, but the humidity of a latitude and month.
#pragma once

#include "msgs/local_frame.h"
#include "ppp/gps_time.h"

namespace maploop::ppp {

struct ZenithDelay {
  double hydrostatic = 0.0, wet = 0.0;  // m; the wet one is a first guess, good to some 5 cm
};

// Hydrostatic by Saastamoinen from the pressure, wet from temperature and vapour and how they
// decrease with height. Heights are taken to be above the sea.
ZenithDelay zenith_delay(const Geodetic& site, GpsTime t);

// Days since the begin of the year, from 1.
double day_of_year(GpsTime t);

}  // namespace maploop::ppp
