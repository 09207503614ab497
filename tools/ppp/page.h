// A page about a run, on one time line: positions relative to the truth, their mean or another
// solution, satellites, sky, residuals, atmosphere, and protection levels.
#pragma once

#include <string>
#include <vector>

#include "tools/ppp/summary.h"

namespace maploop::gnss {

// `summary`: lines of text that stand above. `integrity_risk` is that of the score's levels.
std::string to_page(const std::string& heading, const std::vector<std::string>& summary,
                    const PppResult& result, double integrity_risk);

}  // namespace maploop::gnss
