// A recorded drive in any form that can be replayed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "msgs/calibration.h"
#include "runtime/vehicle/vehicle.h"
#include "runtime/vehicle/vehicle_config.h"

namespace maploop::vehicle {

struct Recording {
  VehicleCalibration calibration;
  Time first_stamp{};  // of the images, or of what stands for them
  Time last_stamp{};
  std::size_t images = 0;
  // Anew, each from the start; those that it has. Pixels and points of what is available up to
  // `passed` may be missing, which saves reading them.
  std::function<Sensors(Time passed)> sensors;
};

// A KITTI raw drive (a folder), or one of our own logs (a file). A log without images gives the
// odometry that was made from them. Throws std::runtime_error naming what is wrong with it.
Recording open_recording(const std::filesystem::path& path, const VehicleConfig& config);

}  // namespace maploop::vehicle
