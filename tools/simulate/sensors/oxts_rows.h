// Writes the rows of the inertial and GNSS unit in KITTI's format.
#pragma once

#include <filesystem>
#include <vector>

#include "msgs/local_frame.h"
#include "msgs/time.h"
#include "tools/simulate/sensors/imu_errors.h"
#include "tools/simulate/sensors/vehicle_motion.h"

namespace maploop::simulate {

// Writes rows `interval` seconds apart, beginning at `start`, into the new folder `oxts`. Position
// and attitude are exact at the row's stamp. Velocities (exact), accelerations and rates (with the
// errors of `imu`) are those of 60 ms before it, as in KITTI's drives.
void write_oxts(const std::filesystem::path& oxts, const VehicleMotion& motion,
                const LocalFrame& frame, Time start, double seconds, double interval,
                const ImuParameters& imu, std::uint64_t seed);

// Writes stamps like KITTI's timestamps.txt, one a line.
void write_timestamps(const std::filesystem::path& file, const std::vector<Time>& stamps);

}  // namespace maploop::simulate
