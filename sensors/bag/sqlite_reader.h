// This file reads the SQLite databases of rosbag2.
#pragma once

#include <memory>
#include <string_view>

#include "sensors/bag/recording_reader.h"

namespace maploop::sensors::bag {

constexpr std::string_view sqlite_magic = "SQLite format 3";

// Opens the database read-only and immutable: nothing is created beside it, and what is in its
// journal is not read, which is reported as damage. SQLite says which row is damaged, not where it
// is in the file: the offset is 0, or the size of the file if it was cut. Throws FileError.
std::unique_ptr<RecordingReader> open_sqlite(const Opening& opening);

}  // namespace maploop::sensors::bag
