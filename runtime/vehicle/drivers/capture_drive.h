// Opens a capture of the packets of a Velodyne scanner.
#pragma once

#include <filesystem>

#include "runtime/vehicle/drivers/recording.h"

namespace maploop::vehicle {

// Returns whether the file is named .pcap or .pcapng, plain or .gz.
bool is_capture(const std::filesystem::path& path);

// The scanner's turns take the place of the images. Throws std::runtime_error naming what is wrong.
Recording open_capture(const std::filesystem::path& path, const VehicleConfig& config);

}  // namespace maploop::vehicle
