// Writes JSON whose texts may come from any sender.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace maploop::dashboard {

// Invalid UTF-8 is replaced.
inline std::string json_text(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace maploop::dashboard
