// Values in the order of a header's types, made into an epoch's signals.
#pragma once

#include "ppp/readers/observation_header.h"

namespace maploop::ppp {

struct Value {
  double value = 0.0;  // 0: missing
  char lli = ' ';
};

// Refused satellites and epochs, with the first reasons.
void refuse(Observations& observations, const Lines& lines, const std::string& why);
// The same of what a stream has at a byte.
void refuse(Observations& observations, std::size_t offset, const std::string& why);

// Appends a satellite; refuses and counts one whose values cannot be.
void append_satellite(Observations& observations, const Lines& lines, Satellite satellite,
                      std::span<const Value> values, Epoch& epoch);
// Keeps an epoch; refuses one that is not after the one before. Takes its content, leaves it empty.
void keep_epoch(Observations& observations, const Lines& lines, Epoch& epoch);

}  // namespace maploop::ppp
