// What a fault does to the contents of one sample.
#pragma once

#include <cstdint>

#include "msgs/gnss.h"
#include "msgs/image.h"
#include "msgs/imu.h"
#include "msgs/lidar_scan.h"
#include "runtime/vehicle/gnss_epoch.h"

namespace maploop::vehicle {

// All stamps of the sample, but not `available`: the sensor's clock is wrong, the line is not.
void shift_stamps(StereoPair& pair, Duration by);
void shift_stamps(LidarScan& scan, Duration by);
void shift_stamps(ImuSample& sample, Duration by);
void shift_stamps(GnssFix& fix, Duration by);
void shift_stamps(GnssEpoch& epoch, Duration by);

// Every measured number, and every covariance.
void fill_with_nan(LidarScan& scan);
void fill_with_nan(ImuSample& sample);
void fill_with_nan(GnssFix& fix);
void fill_with_nan(GnssEpoch& epoch);

// Every measured number, and every covariance, is that of another sample; stamps are its own.
void repeat(ImuSample& sample, const ImuSample& other);
void repeat(GnssFix& fix, const GnssFix& other);
void repeat(GnssEpoch& epoch, const GnssEpoch& other);

void blacken(StereoPair& pair);

// Noise that depends on the seed and the stamp alone, another one in each image.
void scramble(StereoPair& pair, std::uint64_t seed);

// Whether a sample with this stamp is among the share of those that are struck.
bool drawn(double share, std::uint64_t seed, Time stamp);

}  // namespace maploop::vehicle
