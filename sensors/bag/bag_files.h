// This file finds the files of a recording, and opens the reader of each.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "sensors/bag/recording_reader.h"

namespace maploop::sensors::bag {

// Returns whether the file begins as one of the formats, also if it is compressed, and is none of
// our own recordings. Does not throw.
bool is_recording_file(const std::filesystem::path& file);

// Returns whether the file is an MCAP file of our own profile, also compressed. Does not throw.
bool is_own_recording(const std::filesystem::path& file);

// Returns the files of a recording in their order: the file itself, what metadata.yaml names, or
// the recordings of a folder in the natural order of their names. Throws std::runtime_error: none,
// or rosbag2's compression is not Zstandard.
std::vector<std::filesystem::path> recording_files(const std::filesystem::path& path);

// Throws std::runtime_error that names the file: not readable, of another format or version.
std::unique_ptr<RecordingReader> open_file(const std::filesystem::path& file,
                                           const std::shared_ptr<TopicTable>& topics,
                                           const MessageSelection& selection);

}  // namespace maploop::sensors::bag
