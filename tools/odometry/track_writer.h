// Recorded tracks as a file.
#pragma once

#include <filesystem>

#include "runtime/vehicle/recorded_tracks.h"

namespace maploop::odometry {

// Both files, as read_recorded_tracks reads them, the tracks compressed where the name ends in .gz;
// stamps in seconds from frame 0. Throws std::runtime_error naming the file that cannot be written.
void write_recorded_tracks(const std::filesystem::path& file,
                           const vehicle::RecordedTracks& recorded);

}  // namespace maploop::odometry
