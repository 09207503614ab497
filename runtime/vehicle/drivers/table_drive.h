// Opens the tables of a drive: a receiver's fixes, the samples of an inertial unit, wheel speeds.
#pragma once

#include <filesystem>
#include <optional>

#include "runtime/vehicle/drivers/bag_drive.h"
#include "runtime/vehicle/drivers/recording.h"
#include "sensors/folder/table_mapping.h"

namespace maploop::vehicle {

// Returns which tables are which sensor: as maploop.tables.toml in the folder says
// (sensors/FORMATS.md), or else of a folder with gnss.csv or imu.csv, or of a .pos file. Returns
// nothing if the path is none of these. Throws std::runtime_error naming file, line and key.
std::optional<sensors::TableMapping> find_table_mapping(const std::filesystem::path& path);

// Returns whether the path has such tables, and neither images nor clouds.
bool is_table_drive(const std::filesystem::path& path);

// Reads maploop.tables.toml. Throws as above.
sensors::TableMapping read_table_mapping(const std::filesystem::path& file);

// The fixes take the place of the images. Throws std::runtime_error naming what is wrong.
Recording open_tables(const std::filesystem::path& folder, const VehicleConfig& config);

FusedSensors fused_sensors_of(const sensors::TableMapping& mapping);

}  // namespace maploop::vehicle
