// Changes the contents of one sample as a fault demands.
#pragma once

#include <cstdint>

#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "runtime/vehicle/drivers/gnss_epoch.h"

namespace maploop::vehicle {

// Shifts all stamps of the sample, but not `available`: the sensor's clock is wrong, the
// transmission is not.
template <class T>
void shift_stamps(T& sample, Duration by) {
  sample.stamp += by;
  if constexpr (requires { sample.start; }) sample.start += by, sample.end += by;
  if constexpr (requires { sample.velocity_stamp; }) sample.velocity_stamp += by;
  if constexpr (requires { sample.epoch; }) sample.epoch.time += by;
}

// Sets every measured number and every covariance to NaN.
void fill_with_nan(LidarScan& scan);
void fill_with_nan(ImuSample& sample);
void fill_with_nan(GnssFix& fix);
void fill_with_nan(GnssEpoch& epoch);

// Copies every measured number and every covariance from `other`; the stamps stay. From an epoch,
// the satellites and their signals are copied.
void repeat(ImuSample& sample, const ImuSample& other);
void repeat(GnssFix& fix, const GnssFix& other);
void repeat(GnssEpoch& epoch, const GnssEpoch& other);

void blacken(StereoPair& pair);

// Replaces both images by noise that depends only on the seed and the stamp; the two differ.
void scramble(StereoPair& pair, std::uint64_t seed);

// Returns whether a sample with this stamp belongs to the share of samples that are struck.
bool drawn(double share, std::uint64_t seed, Time stamp);

}  // namespace maploop::vehicle
