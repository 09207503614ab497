#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace maploop::testing {

// Returns the hashes of the channels in a replay's JSON; channels without a hash are left out.
inline std::map<std::string, std::string> hashes(const nlohmann::json& result) {
  std::map<std::string, std::string> all;
  for (const auto& [name, channel] : result["channels"].items()) {
    if (channel["hash"] != "") all[name] = channel["hash"];
  }
  return all;
}

}  // namespace maploop::testing
