// Changes the numbers of one sample as a fault demands; image_faults.h and scan_faults.h have those
// of images and scans.
#pragma once

#include <cstdint>
#include <random>

#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "msgs/wheel_speed.h"
#include "runtime/vehicle/drivers/gnss_epoch.h"
#include "runtime/vehicle/faults/strike.h"

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
void fill_with_nan(ImuSample& sample);
void fill_with_nan(GnssFix& fix);
void fill_with_nan(GnssEpoch& epoch);
void fill_with_nan(WheelSpeed& sample);

// Copies everything measured, and every covariance, from `other`; the stamps stay. From an epoch,
// the satellites and their signals are copied.
void repeat(StereoPair& pair, const StereoPair& other);
void repeat(LidarScan& scan, const LidarScan& other);
void repeat(ImuSample& sample, const ImuSample& other);
void repeat(GnssFix& fix, const GnssFix& other);
void repeat(GnssEpoch& epoch, const GnssEpoch& other);
void repeat(WheelSpeed& sample, const WheelSpeed& other);

// Moves the position by metres east, north and up; the covariance stays.
void move(GnssFix& fix, const Eigen::Vector3d& by);

// Applies a fault that changes numbers: nan, bias, drift, scale, noise, spoofed. The first errs by
// `by` on every axis of the target. Other kinds leave the sample as it is.
void distort(ImuSample& sample, const Strike& strike);
void distort(GnssFix& fix, const Strike& strike);
void distort(GnssEpoch& epoch, const Strike& strike);
void distort(WheelSpeed& sample, const Strike& strike);

// The C++ standard fixes the sequence of this generator and how it takes its seed.
std::mt19937_64 generator(std::uint64_t seed, Time stamp);

// Returns whether a sample with this stamp belongs to the share of samples that are struck.
bool drawn(double share, std::uint64_t seed, Time stamp);

}  // namespace maploop::vehicle
