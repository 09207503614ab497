// How a fault strikes one sample.
#pragma once

#include <cstdint>

#include "runtime/vehicle/faults/fault.h"

namespace maploop::vehicle {

struct Strike {
  FaultKind kind;
  FaultTarget target;
  double by;                  // in the unit of the fault's rule
  double elapsed;             // s, since the first sample that was struck
  std::uint64_t seed;         // of random numbers, which depend on the sample's stamp, too
  double focal_length = 0.0;  // px, of a camera
};

}  // namespace maploop::vehicle
