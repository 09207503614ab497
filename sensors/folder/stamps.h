// This file reads the stamps of files: from their names, or from a text with a line for each.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "msgs/time.h"

namespace maploop::sensors {

// Returns the moment that a text says: seconds with a point, exact to the nanosecond; a whole
// number from 1e8 on of s, ms, us or ns from 1970, told apart by its size; or KITTI's time stamp.
// Returns nothing for other texts, such as a frame's number.
std::optional<Time> stamp_of(std::string_view text);

// Reads a text with a line for each frame: a number of seconds of any size, or what stamp_of()
// takes. Of several words the second counts ("number stamp exposure"), unless they are date and
// time. Lines that begin with # are comments. Throws std::runtime_error that names file and line of
// what is no stamp, or does not increase.
std::vector<Time> read_times(const std::filesystem::path& file);

// Returns the names of the files with one of the extensions (".png"), plain or .gz, in the order in
// which numbers count as numbers: scan9 is before scan10. Throws std::runtime_error beyond
// input_limits::frames.
std::vector<std::string> files_of_kind(const std::filesystem::path& folder,
                                       std::initializer_list<std::string_view> extensions);

// Returns the stamps that all of the names are, without their extension; nothing if one is not, or
// if they do not increase.
std::optional<std::vector<Time>> stamps_in_names(const std::vector<std::string>& names);

// Returns the file of stamps in a folder, timestamps.txt or times.txt; nothing: there is none.
std::optional<std::filesystem::path> times_file(const std::filesystem::path& folder);

}  // namespace maploop::sensors
