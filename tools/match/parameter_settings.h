// Sets parameters of map matching from a command line.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mapmatch/match_parameters.h"

namespace maploop::match {

// Returns the defaults changed by each NAME=VALUE. Throws std::runtime_error naming what is wrong.
mapmatch::MatchParameters parameters_with(const std::vector<std::string>& settings);

// Splits a setting NAME=VALUE. Throws std::runtime_error naming what is wrong.
std::pair<std::string, double> parse_setting(const std::string& setting);

}  // namespace maploop::match
