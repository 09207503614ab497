// Sets parameters from a command line.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapmatch/parameter_table.h"
#include "tools/evaluate/text_lines.h"

namespace maploop::match {

// Sets the numbers that settings NAME=NUMBER name, in each of the structs that has such a
// parameter. Throws std::runtime_error naming what is wrong, also if none has it.
template <class... Parameters>
void apply_settings(const std::vector<std::string>& settings, Parameters&... parameters) {
  for (const std::string& setting : settings) {
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error("--set " + setting + ": " + what);
    };
    const std::size_t equal = std::min(setting.find('='), setting.size() - 1);
    const auto number = evaluation::number_of<double>(setting.substr(equal + 1));
    if (!number || !std::isfinite(*number)) fail("it is NAME=NUMBER");
    bool found = false;
    try {
      ((found |= set_number(parameters, setting.substr(0, equal), *number)), ...);
    } catch (const std::invalid_argument& e) {
      fail(e.what());
    }
    if (!found) fail("there is no such parameter");
  }
}

}  // namespace maploop::match
