// Ocean loading coefficients of stations: BLQ, as the Chalmers service makes them.
#pragma once

#include <array>
#include <vector>

#include "ppp/readers/lines.h"

namespace maploop::ppp {

// Constituents M2 S2 N2 K2 K1 O1 P1 Q1 Mf Mm Ssa; components up, west, south.
struct OceanLoading {
  std::string station;
  std::array<std::array<double, 11>, 3> amplitude{};  // m
  std::array<std::array<double, 11>, 3> phase{};      // rad, lag at Greenwich
  // Degrees, of the comment that the service writes; outside [-90, 90] where there is none.
  double longitude = 0.0, latitude = 999.0;
};

struct OceanLoadingFile {
  std::string file;
  std::vector<OceanLoading> stations;
};

OceanLoadingFile parse_blq(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
