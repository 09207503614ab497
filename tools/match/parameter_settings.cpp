#include "tools/match/parameter_settings.h"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "mapmatch/parameter_fields.h"
#include "mapmatch/validate.h"

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
    bool found = false;
    mapmatch::fields(parameters, [&, w = wanted, n = number](const char* name, auto& value) {
      if (w != name) return;
      value = static_cast<std::remove_reference_t<decltype(value)>>(n);
      found = true;
    });
    if (!found) throw std::runtime_error("--set " + setting + ": there is no such parameter");
  }
  try {
    mapmatch::validate(parameters);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(std::string("--set: ") + e.what());
  }
  return parameters;
}

}  // namespace maploop::match
