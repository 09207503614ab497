// This file writes a KITTI drive in the layouts of other data sets, with the same files.
#pragma once

#include <filesystem>
#include <string>

#include "sensors/replay/kitti_drive.h"

namespace maploop::testing {

// Writes a text file, and the folders above it.
void write_text(const std::filesystem::path& file, const std::string& text);

// Writes the drive below `root` in each layout; images and scans are links to the drive's. Only the
// first `frames` are used. The inertial rows of EuRoC's are the drive's three values, the other
// three being 0 but for gravity.
void write_as_euroc(const sensors::KittiDrive& drive, const std::filesystem::path& root,
                    std::size_t frames);
void write_as_kitti_360(const sensors::KittiDrive& drive, const std::filesystem::path& root,
                        std::size_t frames);
// Writes left.txt and right.txt, and a folder `lidar` whose files are named by their stamps.
void write_as_lists(const sensors::KittiDrive& drive, const std::filesystem::path& root,
                    std::size_t frames);

}  // namespace maploop::testing
