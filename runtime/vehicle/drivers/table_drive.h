// Opens the tables of a drive: a receiver's fixes, and the samples of an inertial unit.
#pragma once

#include <filesystem>

#include "runtime/vehicle/drivers/recording.h"

namespace maploop::vehicle {

// The fixes take the place of the images. Throws std::runtime_error naming what is wrong.
Recording open_tables(const std::filesystem::path& folder, const VehicleConfig& config);

}  // namespace maploop::vehicle
