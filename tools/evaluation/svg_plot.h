// Line plots as SVG, for pages that need nothing but a browser.
#pragma once

#include <string>
#include <vector>

namespace maploop::evaluation {

struct Line {
  std::string name;
  std::vector<double> x, y;  // same lengths; points that are not finite are left out
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<Line> lines;
  bool equal_axes = false;       // a map: one metre is as long on both axes
  std::vector<Line> background{};  // thin and grey, below the lines, where these are; no names
};

std::string to_svg(const Plot& plot);

// A page of its own with a heading, `body` (HTML) and the plots.
std::string to_page(const std::string& heading, const std::string& body,
                    const std::vector<Plot>& plots);

}  // namespace maploop::evaluation
