// Writes JSON files.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/evaluate/text_file.h"

namespace maploop::tools {

// Throws std::runtime_error naming the file when it cannot be written.
inline void write_json_file(const std::filesystem::path& file, const nlohmann::json& json) {
  using Handler = nlohmann::json::error_handler_t;
  evaluation::write_text(file, json.dump(2, ' ', false, Handler::replace) + '\n');
}

}  // namespace maploop::tools
