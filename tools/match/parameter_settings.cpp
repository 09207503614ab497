#include "tools/match/parameter_settings.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "mapmatch/parameter_table.h"

namespace maploop::match {

std::pair<std::string, double> parse_setting(const std::string& setting) {
  const auto equal = setting.find('=');
  double number = 0.0;
  const char* const end = setting.data() + setting.size();
  const bool good = equal != std::string::npos &&
                    std::from_chars(setting.data() + equal + 1, end, number).ptr == end &&
                    equal + 1 < setting.size() && std::isfinite(number);
  if (!good) throw std::runtime_error("--set " + setting + ": it is NAME=NUMBER");
  return {setting.substr(0, equal), number};
}

mapmatch::MatchParameters parameters_with(const std::vector<std::string>& settings) {
  mapmatch::MatchParameters parameters;
  for (const std::string& setting : settings) {
    const auto [wanted, number] = parse_setting(setting);
    try {
      if (set_number(parameters, wanted, number)) continue;
    } catch (const std::invalid_argument& e) {
      throw std::runtime_error("--set " + setting + ": " + e.what());
    }
    throw std::runtime_error("--set " + setting + ": there is no such parameter");
  }
  return parameters;
}

}  // namespace maploop::match
