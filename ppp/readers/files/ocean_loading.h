// Reads ocean loading coefficients of stations from BLQ, as the Chalmers service writes it.
#pragma once

#include <array>
#include <vector>

#include "ppp/readers/files/lines.h"

namespace maploop::ppp {

// The constituents are M2 S2 N2 K2 K1 O1 P1 Q1 Mf Mm Ssa; the components are up, west, south.
struct OceanLoading {
  std::string station;
  std::array<std::array<double, 11>, 3> amplitude{};  // m
  std::array<std::array<double, 11>, 3> phase{};      // rad, lag at Greenwich
  // Both are in degrees, from the comment that the service writes; the latitude is 999 if there is
  // none.
  double longitude = 0.0, latitude = 999.0;
};

struct OceanLoadingFile {
  std::string file;
  std::vector<OceanLoading> stations;
};

OceanLoadingFile parse_blq(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
