// Reads earth rotation parameters from IGS ERP version 2.
#pragma once

#include <vector>

#include "ppp/readers/files/lines.h"

namespace maploop::ppp {

struct EarthRotation {
  double mjd = 0.0;                   // UTC
  double x_pole = 0.0, y_pole = 0.0;  // rad
  double ut1_minus_utc = 0.0;         // s
  double length_of_day = 0.0;         // s
};

struct EarthRotationFile {
  std::string file;
  std::vector<EarthRotation> days;  // in the order of time
};

EarthRotationFile parse_erp(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
