// The inertial and GNSS unit's rows, as KITTI writes them.
#pragma once

#include <filesystem>
#include <vector>

#include "msgs/local_frame.h"
#include "msgs/time.h"
#include "tools/simulate/imu_errors.h"
#include "tools/simulate/vehicle_motion.h"

namespace maploop::simulate {

// Rows `interval` seconds apart from `start` on, into the new folder `oxts`: position and attitude
// without error, of the row's stamp; velocities without error, accelerations and rates with a
// unit's own, of 60 ms before it, as in KITTI's drives.
void write_oxts(const std::filesystem::path& oxts, const VehicleMotion& motion,
                const LocalFrame& frame, Time start, double seconds, double interval,
                const ImuParameters& imu, std::uint64_t seed);

// Stamps as KITTI's timestamps.txt, one a line.
void write_timestamps(const std::filesystem::path& file, const std::vector<Time>& stamps);

}  // namespace maploop::simulate
