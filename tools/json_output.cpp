#include "tools/json_output.h"

#include <fstream>
#include <stdexcept>
#include <string>

namespace maploop::tools {

using nlohmann::json;

json to_json(const std::vector<RealtimeSetting>& settings) {
  json all = json::array();
  for (const RealtimeSetting& s : settings) {
    all.push_back({{"name", s.name},
                   {"asked", s.asked},
                   {"granted", s.granted},
                   {"verdict", to_string(s.verdict)},
                   {"reason", s.reason},
                   {"remedy", s.remedy}});
  }
  return all;
}

json to_json(const SensorClock& c) {
  return {{"drift", c.drift},
          {"delay_s", to_seconds(c.delay)},
          {"jumps", c.jumps},
          {"utc_ahead_s", c.utc_ahead ? json(to_seconds(*c.utc_ahead)) : json(nullptr)}};
}

void write_json_file(const std::filesystem::path& file, const json& j) {
  std::ofstream out(file);
  out << j.dump(2, ' ', false, json::error_handler_t::replace) << '\n';
  out.close();
  if (!out) {
    throw std::runtime_error("cannot write '" + file.string() +
                             "': check that its folder exists and may be written");
  }
}

}  // namespace maploop::tools
