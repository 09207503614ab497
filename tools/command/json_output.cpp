#include "tools/command/json_output.h"

#include "tools/evaluate/text_file.h"

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
  evaluation::write_text(file, j.dump(2, ' ', false, json::error_handler_t::replace) + '\n');
}

}  // namespace maploop::tools
