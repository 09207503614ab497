#include "tools/match/parameter_settings.h"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <type_traits>

#include "mapmatch/parameter_fields.h"
#include "mapmatch/validate.h"

namespace maploop::match {

mapmatch::MatchParameters parameters_with(const std::vector<std::string>& settings) {
  mapmatch::MatchParameters parameters;
  for (const std::string& setting : settings) {
    const auto equal = setting.find('=');
    double number = 0.0;
    const char* const end = setting.data() + setting.size();
    const bool good = equal != std::string::npos &&
                      std::from_chars(setting.data() + equal + 1, end, number).ptr == end &&
                      equal + 1 < setting.size() && std::isfinite(number);
    if (!good) throw std::runtime_error("--set " + setting + ": it is NAME=NUMBER");
    bool found = false;
    mapmatch::fields(parameters, [&](const char* name, auto& value) {
      if (setting.compare(0, equal, name) != 0) return;
      value = static_cast<std::remove_reference_t<decltype(value)>>(number);
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
