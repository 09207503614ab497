// Reads biases of codes and phases from Bias-SINEX 1.00 (absolute OSB and differential DSB), and
// those of codes from CODE's DCB files.
#pragma once

#include <vector>

#include "ppp/readers/files/lines.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

// A SignalBias is the bias of one signal, or that of the first minus that of the second. It must be
// subtracted from a measurement. With the biases of both carriers' phases, ambiguities are
// integers.
struct SignalBias {
  Satellite satellite;
  std::string signal, second;  // such as "C1W" or "L1C"; second is empty for an absolute bias
  GpsTime from{}, until{};
  double metres = 0.0;
};

struct BiasFile {
  std::string file, agency;
  std::vector<SignalBias> biases;  // of satellites
  int skipped = 0;                 // of stations, between phases or systems, of phases in cycles
};

BiasFile parse_bias_sinex(std::string_view text, const std::string& file);
// Reads P1-C1, P2-C2 or P1-P2 of one month, as CODE publishes them.
BiasFile parse_dcb(std::string_view text, const std::string& file);

}  // namespace maploop::ppp
