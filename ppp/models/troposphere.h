// Computes mapping functions of the troposphere (GMF: Boehm, Niell, Tregoning and Schuh 2006).
#pragma once

#include "msgs/local_frame.h"
#include "ppp/gps_time.h"

namespace maploop::ppp {

struct Mapping {
  double hydrostatic = 0.0, wet = 0.0;
};
// Holds what is constant for one place and epoch; only the part that depends on the elevation is
// computed by at().
class GlobalMapping {
 public:
  GlobalMapping() = default;
  GlobalMapping(const Geodetic& site, GpsTime t);
  Mapping at(double elevation) const;  // rad, above 0

 private:
  double hydrostatic_[3] = {}, wet_[3] = {}, height_km_ = 0.0;
};

}  // namespace maploop::ppp
