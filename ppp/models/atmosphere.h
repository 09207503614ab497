// Models the air at a place and season by the climatology of the RTCA's minimum operational
// performance standards (DO-229, appendix A). It uses no measurements, only the average humidity of
// latitude and season.
#pragma once

#include "msgs/local_frame.h"
#include "ppp/gps_time.h"

namespace maploop::ppp {

struct ZenithDelay {
  double hydrostatic = 0.0, wet = 0.0;  // m; the wet one is a first guess, good to about 5 cm
};

// The hydrostatic delay is that of Saastamoinen from the pressure. The wet delay follows from
// temperature and vapour and their decrease with height. Heights are taken as heights above the
// sea.
ZenithDelay zenith_delay(const Geodetic& site, GpsTime t);

// Returns the day of the year in GPS time, starting from 1.
double day_of_year(GpsTime t);

}  // namespace maploop::ppp
