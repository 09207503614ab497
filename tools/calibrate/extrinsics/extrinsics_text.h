// This file writes the extrinsics that were found as text, JSON and TOML.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/calibrate/extrinsics/extrinsics.h"

namespace maploop::extrinsics {

std::string to_text(const Extrinsics& found);
nlohmann::json to_json(const Extrinsics& found);

// Returns the vehicle description, with a comment that says where it is from.
std::string to_toml(const Extrinsics& found, const std::string& recording);

}  // namespace maploop::extrinsics
