// Opens a folder of images, scans, rows and tables of any known layout as a recorded drive.
#pragma once

#include <filesystem>
#include <optional>

#include "runtime/vehicle/drivers/bag_drive.h"
#include "runtime/vehicle/drivers/recording.h"

namespace maploop::vehicle {

// Opens EuRoC's format, KITTI-360's, folders of images, clouds and tables (sensors/FORMATS.md), or
// else KITTI's raw format. Throws std::runtime_error naming what is wrong.
Recording open_folder(const std::filesystem::path& folder, const VehicleConfig& config);

// Says what a folder has, if it is of a layout whose configuration is not the default. Throws as
// open_folder().
std::optional<FusedSensors> fused_sensors_of_folder(const std::filesystem::path& folder);

}  // namespace maploop::vehicle
