// Converts values in the order of a header's types into an epoch's signals.
#pragma once

#include "ppp/readers/files/observation_header.h"

namespace maploop::ppp {

struct Value {
  double value = 0.0;  // 0: missing
  char lli = ' ';
};

// Counts a refused satellite or epoch and keeps the first reasons, with file and line.
void refuse(Observations& observations, const Lines& lines, const std::string& why);
// Does the same for an error, which names them.
void refuse(Observations& observations, const ReadError& error);
// Does the same for a stream, with the offset of a byte.
void refuse(Observations& observations, std::size_t offset, const std::string& why);

// Appends a satellite. Values that cannot be right and repeated satellites are refused and counted.
void append_satellite(Observations& observations, const Lines& lines, Satellite satellite,
                      std::span<const Value> values, Epoch& epoch);

}  // namespace maploop::ppp
