// This file computes how much memory a vehicle's threads and rings hold at most, from what they
// declare.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "runtime/vehicle/config/scheduling_config.h"

namespace maploop::vehicle {

// States how large the largest samples are: one image of a pair, and one scan.
struct SampleSizes {
  std::size_t pixels = 0;
  std::size_t points = 0;
};

// States how many bytes one thread, or one ring, holds.
struct MemoryPart {
  std::string name;       // "stereo", or "camera -> stereo"
  std::size_t count = 1;  // slots of a ring
  std::size_t each = 0;   // bytes
  std::size_t bytes() const { return count * each; }
};

// Returns the parts of a vehicle with every stage and every ring that are declared: threads before
// rings, the largest first. A thread has its stack and what its estimator holds; a recording's
// driver has the images or scans that are decoded ahead. Neither the road map, nor the program
// itself, nor states that are saved to go back to are among them.
std::vector<MemoryPart> memory_budget(const SampleSizes& sizes,
                                      const SchedulingParameters& scheduling);

}  // namespace maploop::vehicle
