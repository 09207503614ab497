// A page about a run: error against the truth and its protection levels, satellites, residuals,
// sky.
#pragma once

#include <string>

#include "tools/ppp/position_files.h"
#include "tools/ppp/score.h"

namespace maploop::gnss {

// `score` may be none, and so may that of the same filter without the map; `integrity_risk` is that
// of its levels. `summary`: lines of text that stand above.
std::string to_page(const std::string& heading, const std::vector<std::string>& summary,
                    const Solutions& solutions, const Score* score, const Score* without_map,
                    double integrity_risk);

}  // namespace maploop::gnss
