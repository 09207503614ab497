// Random numbers that do not depend on the standard library.
#pragma once

#include <cstdint>

namespace maploop::simulate {

// splitmix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", 2014).
constexpr std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

constexpr std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
  return mix(mix(a) ^ b);
}

// Returns a number in [0, 1).
constexpr double unit(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1p-53;
}

// One stream of a seed. Each part of the world draws from its own stream, so that a change of one
// part does not change the others.
class Random {
 public:
  constexpr Random(std::uint64_t seed, std::uint64_t stream) : state_(mix(seed, stream)) {}

  constexpr std::uint64_t bits() { return state_ = mix(state_); }
  constexpr double uniform(double from, double to) { return from + (to - from) * unit(bits()); }
  constexpr float uniform_float(double from, double to) {
    return static_cast<float>(uniform(from, to));
  }
  constexpr bool chance(double probability) { return unit(bits()) < probability; }
  constexpr std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>(unit(bits()) * count);
  }
  // Approximately standard normal: the sum of twelve uniform numbers (Irwin-Hall), within six
  // sigma.
  constexpr double normal() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += unit(bits());
    return sum;
  }

 private:
  std::uint64_t state_;
};

}  // namespace maploop::simulate
