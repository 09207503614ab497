// This file generates random numbers that are the same with every standard library.
#pragma once

#include <cstdint>
#include <random>

#include "msgs/time.h"

namespace maploop::sensors {

// Generates standard normal numbers that depend only on a seed and a stamp: std::mt19937_64, whose
// sequence the C++ standard fixes, seeded with both mixed by splitmix64 (Steele, Lea, Flood, "Fast
// Splittable Pseudorandom Number Generators", 2014), and the Box-Muller transform. (The results of
// std::normal_distribution differ between libraries.)
class NormalGenerator {
 public:
  NormalGenerator(std::uint64_t seed, Time stamp);
  double next();
  // These draw from [from, to), uniformly or log-uniformly (from > 0).
  double uniform(double from, double to);
  double log_uniform(double from, double to);

 private:
  std::mt19937_64 uniform_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace maploop::sensors
