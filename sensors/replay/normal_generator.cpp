#include "sensors/replay/normal_generator.h"

#include <cmath>
#include <numbers>

namespace maploop::sensors {
namespace {

std::uint64_t splitmix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

// Converts 53 random bits to a number in [0, 1).
double unit_interval(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1p-53;
}

}  // namespace

NormalGenerator::NormalGenerator(std::uint64_t seed, Time stamp)
    : uniform_(splitmix64(splitmix64(seed) ^ static_cast<std::uint64_t>(to_nanoseconds(stamp)))) {}

double NormalGenerator::next() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - unit_interval(uniform_())));
  const double angle = 2.0 * std::numbers::pi * unit_interval(uniform_());
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

double NormalGenerator::uniform(double from, double to) {
  return from + (to - from) * unit_interval(uniform_());
}

double NormalGenerator::log_uniform(double from, double to) {
  return from * std::pow(to / from, uniform(0.0, 1.0));
}

}  // namespace maploop::sensors
