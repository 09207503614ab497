// Keeps the filter of PPP in a file, with its ambiguities, so that the next run starts with it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "msgs/archive.h"
#include "runtime/vehicle/config/car_state.h"

namespace maploop::vehicle {

// `filter` is what the ppp stage saved of itself. Replaces the file when it is written whole.
// Throws std::runtime_error that names the file and states what to do.
void write_kept_ppp(const std::filesystem::path& file, const std::string& car, const Bytes& filter);

// Returns what was written; nothing if there is no such file. Throws std::runtime_error that names
// the file and what is wrong: not readable, or of another car; DamagedCarState: cut, changed, or
// of another version.
std::optional<Bytes> read_kept_ppp(const std::filesystem::path& file, const std::string& car);

}  // namespace maploop::vehicle
