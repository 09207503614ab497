#include "runtime/vehicle/faults/fault_corruption.h"

#include <algorithm>
#include <limits>
#include <random>

namespace maploop::vehicle {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// The C++ standard fixes the sequence of this generator and how it takes its seed.
std::mt19937_64 generator(std::uint64_t seed, Time stamp) {
  const auto t = static_cast<std::uint64_t>(to_nanoseconds(stamp));
  std::seed_seq sequence{seed & 0xffffffffU, seed >> 32U, t & 0xffffffffU, t >> 32U};
  return std::mt19937_64(sequence);
}

}  // namespace

void fill_with_nan(LidarScan& scan) {
  constexpr float f = std::numeric_limits<float>::quiet_NaN();
  std::fill(scan.points.begin(), scan.points.end(), LidarPoint{f, f, f, f});
}

void fill_with_nan(ImuSample& sample) {
  const double other = sample.six_axes ? nan : 0.0;
  sample.values() = {nan, nan, nan, sample.six_axes, other, other, other};
}

void fill_with_nan(GnssFix& fix) {
  fix.position = {nan, nan, nan};
  fix.position_covariance.setConstant(nan);
  fix.velocity_enu.setConstant(nan);
  fix.velocity_covariance.setConstant(nan);
}

void fill_with_nan(GnssEpoch& epoch) {
  for (ppp::Signal& signal : epoch.epoch.signals) {
    signal.code = signal.phase = signal.doppler = signal.cn0 = nan;
  }
}

void repeat(ImuSample& sample, const ImuSample& other) {
  sample.values() = other.values();
}

void repeat(GnssFix& fix, const GnssFix& other) {
  fix.position = other.position;
  fix.position_covariance = other.position_covariance;
  fix.velocity_enu = other.velocity_enu;
  fix.velocity_covariance = other.velocity_covariance;
}

void repeat(GnssEpoch& epoch, const GnssEpoch& other) {
  epoch.epoch.satellites = other.epoch.satellites;
  epoch.epoch.signals = other.epoch.signals;
}

void blacken(StereoPair& pair) {
  for (GreyImage* image : {&pair.left, &pair.right}) {
    std::fill(image->pixels.begin(), image->pixels.end(), std::uint8_t{0});
  }
}

void scramble(StereoPair& pair, std::uint64_t seed) {
  std::mt19937_64 random = generator(seed, pair.stamp);
  for (GreyImage* image : {&pair.left, &pair.right}) {
    for (std::uint8_t& pixel : image->pixels) pixel = static_cast<std::uint8_t>(random() >> 56U);
  }
}

bool drawn(double share, std::uint64_t seed, Time stamp) {
  // 53 random bits give a number in [0, 1).
  return share >= 1.0 || static_cast<double>(generator(seed, stamp)() >> 11U) * 0x1p-53 < share;
}

}  // namespace maploop::vehicle
