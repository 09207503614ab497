// This file finds the files of a drive that is a table of OXTS rows.
#pragma once

#include <filesystem>
#include <optional>

#include "msgs/time.h"

namespace maploop::sensors {

// Only the table is required.
struct SequenceFiles {
  std::filesystem::path table;  // t and the 30 columns of OXTS
  Time start{};                 // the moment at which t is zero
  std::optional<std::filesystem::path> gaps, times, imu, tracks, labels;
};

// Returns `name` or `name`.gz, whichever is a file.
std::optional<std::filesystem::path> existing_table(const std::filesystem::path& name);

// Returns the moment at which the seconds of a table are zero: 1970 UTC if they begin above
// 100 000 000, otherwise 2000-01-01 00:00:00 UTC, which stands for an unknown start.
Time start_of_seconds(double first);

// `path` is the table itself, a .csv or .csv.gz of any name whose heading begins with t and ends
// with OXTS's last column, orimode; or FOLDER/NAME where the table is FOLDER/oxts/NAME.csv[.gz].
// Returns nothing if it is neither. sensors/FORMATS.md states where the other files are looked for,
// and what the table's t counts from. Throws std::runtime_error that names file and line if a list
// of sequences cannot be read.
std::optional<SequenceFiles> find_sequence(const std::filesystem::path& path);

}  // namespace maploop::sensors
