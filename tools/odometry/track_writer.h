// Writes recorded tracks as a file.
#pragma once

#include <filesystem>

#include "runtime/vehicle/drivers/recorded_tracks.h"

namespace maploop::odometry {

// Writes the tracks and their .meta.json in the format of read_recorded_tracks(); the tracks are
// compressed if the name ends in .gz. Stamps are in seconds from frame 0. Throws std::runtime_error
// naming the file that cannot be written.
void write_recorded_tracks(const std::filesystem::path& file,
                           const vehicle::RecordedTracks& recorded);

}  // namespace maploop::odometry
