// The files of a drive that is a table of OXTS rows, wherever they lie.
#pragma once

#include <filesystem>
#include <optional>

#include "msgs/time.h"

namespace maploop::sensors {

// Everything but the table is optional.
struct SequenceFiles {
  std::filesystem::path table;  // t and the 30 columns of OXTS
  Time start{};                 // when t is zero
  std::optional<std::filesystem::path> gaps, times, imu, tracks, labels;
};

// `path` is the table itself, a .csv or .csv.gz of any name whose heading begins with t and ends
// with OXTS's last column, orimode; or FOLDER/NAME where the table is FOLDER/oxts/NAME.csv[.gz].
// Nothing where it is neither. sensors/FORMATS.md says where the other files are looked for, and
// what the table's t counts from. Throws std::runtime_error naming file and line where a list of
// sequences cannot be read.
std::optional<SequenceFiles> find_sequence(const std::filesystem::path& path);

}  // namespace maploop::sensors
