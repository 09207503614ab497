// What every sample and every result carries.
#pragma once

#include <concepts>
#include <cstdint>

#include "msgs/time.h"

namespace maploop {

struct Sample {
  Time stamp{};              // when it was measured (a result: what moment it speaks of)
  Time available{};          // when the sensor delivers it (a result: trigger's available + budget)
  MonotonicTime received{};  // when this machine had it; never part of a result's data
  std::uint64_t sequence = 0;  // counts up by one per sample of a source; a gap is a loss
};

// `received` is left out: another run has its own. Only for a Sample itself, so that no sample
// derived from it is described by this alone.
template <class Archive, std::same_as<Sample> S>
void archive(Archive& ar, S& s) {
  ar(s.stamp, s.available, s.sequence);
}

}  // namespace maploop
