// Parameters of map matching from a command line.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mapmatch/match_parameters.h"

namespace maploop::match {

// The defaults with NAME=VALUE of each. Throws std::runtime_error naming what is wrong.
mapmatch::MatchParameters parameters_with(const std::vector<std::string>& settings);

// A setting NAME=VALUE in its two parts. Throws as above.
std::pair<std::string, double> parse_setting(const std::string& setting);

}  // namespace maploop::match
