// Reads the epochs of an observation file and goes on behind those that cannot be read.
#pragma once

#include <functional>

#include "ppp/observations.h"
#include "ppp/readers/files/lines.h"

namespace maploop::ppp {

struct EpochReading {
  // Reads the epoch that begins at the current line, up to its last line. Returns false if the file
  // ends inside it; throws ReadError if it cannot be read.
  std::function<bool()> read;
  // Returns whether reading goes on at the current line, after an epoch that could not be read.
  std::function<bool()> resumes;
};

// Reads up to the end of the file. What cannot be read is refused, with its lines up to those where
// reading goes on. Throws ReadError with the first reason if these are more than half of the lines.
void read_epochs(Lines& lines, Observations& result, const EpochReading& reading);

}  // namespace maploop::ppp
