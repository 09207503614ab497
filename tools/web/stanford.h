// The usual picture of protection levels: each error against its level.
#pragma once

#include <string>
#include <vector>

#include "tools/web/plot.h"

namespace maploop::web {

// `errors` are lines of points: x is an error in metres, y its protection level. Errors beyond
// their level lie below the diagonal, which is added.
Plot stanford_plot(std::string title, std::vector<Line> errors);

}  // namespace maploop::web
