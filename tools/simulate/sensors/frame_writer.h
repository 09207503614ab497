// Writes the camera images and the LiDAR scans of a drive.
#pragma once

#include <filesystem>

#include "tools/simulate/drive.h"

namespace maploop::simulate {

// Writes into image_00, image_01 and velodyne_points below `folder`, which must exist, on as many
// threads as the options state. Returns false if `frame_done` stopped it.
bool write_frames(const Drive& drive, const std::filesystem::path& folder,
                  const SimulationOptions& options, const FrameDone& frame_done);

}  // namespace maploop::simulate
