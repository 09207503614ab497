// Opens a bag or an MCAP file as a recorded drive.
#pragma once

#include <filesystem>

#include "runtime/vehicle/drivers/recording.h"

namespace maploop::vehicle {

// Which topic is which sensor is said by sensors/bag/topic_choice.h. Throws std::runtime_error
// naming what is wrong.
Recording open_bag(const std::filesystem::path& path, const VehicleConfig& config);

}  // namespace maploop::vehicle
