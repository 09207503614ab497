// This file defines the stamps that every sample and every result contains.
#pragma once

#include <concepts>
#include <cstdint>

#include "msgs/time.h"

namespace maploop {

// This is the base of every sample of a sensor and every result of an estimator.
struct Sample {
  Time stamp{};              // moment of the measurement (of a result: the moment it describes)
  Time available{};          // when the sensor delivers it (a result: trigger's available + budget)
  MonotonicTime received{};  // when this machine received it; never part of a result's data
  std::uint64_t sequence = 0;  // increases by one per sample of a source; a gap is a loss
};

// `received` is left out, because it differs between runs. The constraint allows only a Sample
// itself, so that no derived sample is described by this function alone.
template <class Archive, std::same_as<Sample> S>
void archive(Archive& ar, S& s) {
  ar(s.stamp, s.available, s.sequence);
}

}  // namespace maploop
