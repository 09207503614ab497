#include "tools/web/stanford.h"

#include <algorithm>
#include <utility>

namespace maploop::web {

Plot stanford_plot(std::string title, std::vector<Line> errors) {
  double largest = 0.0;
  for (const Line& line : errors) {
    for (const double error : line.x) largest = std::max(largest, error);
  }
  errors.push_back({"error = level", {0.0, largest}, {0.0, largest}});
  return {std::move(title), "error, m", "protection level, m", std::move(errors)};
}

}  // namespace maploop::web
