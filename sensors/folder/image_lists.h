// This file finds the stereo images of a folder of any layout, and their stamps.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "msgs/time.h"
#include "sensors/folder/folder_drive.h"
#include "sensors/replay/stereo_source.h"

namespace maploop::sensors {

// Parses a list of images, a line each: a stamp (stamp_of()) and a file's name relative to the
// list's folder, separated by a comma (EuRoC's data.csv) or blanks (TUM's rgb.txt). Lines that
// begin with # are comments. A wrong line gets a verdict, as does a name outside of the folder.
// Throws std::runtime_error that names the file if it has no image.
ImageFolder parse_image_list(std::string_view text, const std::filesystem::path& file);
ImageFolder read_image_list(const std::filesystem::path& file);

// Pairs images by their stamps: each left one with the nearest right one within `max_skew`. What
// has no partner is reported. Throws std::runtime_error if nothing has.
ImagePair paired(const ImageFolder& left, const ImageFolder& right, Duration max_skew);

// Returns the images of a folder with left.txt and right.txt, or with two folders of images whose
// names are one of left and right, cam0 and cam1, image_0 and image_1, image_left and image_right,
// with PNG or JPEG files; their stamps are in data.csv (EuRoC), in times.txt or timestamps.txt in
// the folder of the camera or in `folder`, or the files' names. A camera may also be a video, such
// as left.mp4, with a stamp a line in left.txt, or for both cameras in times.txt or timestamps.txt.
// Returns nothing if there are no such images. Throws std::runtime_error that names what is
// missing: stamps, or one of the cameras.
std::optional<ImagePair> find_images(const std::filesystem::path& folder, Duration max_skew);

// Returns whether the folder has images of at least one camera that find_images() knows.
bool has_images(const std::filesystem::path& folder);

// Returns a folder below `folder` with scans alone (scan_folder.h); nothing: there is none.
std::optional<std::filesystem::path> find_scans(const std::filesystem::path& folder);

}  // namespace maploop::sensors
