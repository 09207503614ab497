#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace maploop::testing {

// Of the channels in a replay's JSON; those that are not hashed are left out.
inline std::map<std::string, std::string> hashes(const nlohmann::json& result) {
  std::map<std::string, std::string> all;
  for (const auto& [name, channel] : result["channels"].items()) {
    if (channel["hash"] != "") all[name] = channel["hash"];
  }
  return all;
}

}  // namespace maploop::testing
