// What a picture on a page shows; the page's script draws it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace maploop::web {

struct Line {
  enum class Look { solid, dashed, steps, points };

  std::string name;
  std::vector<double> x, y;  // same lengths; a value that is not finite breaks the line
  Look look = Look::solid;
};

// Filled between two lines.
struct Band {
  std::string name;
  std::vector<double> x, low, high;  // same lengths
};

// A value of x that is marked: a deadline.
struct Mark {
  double value = 0.0;
  std::string name;
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<Line> lines = {};
  bool equal_axes = false;       // a map: one metre is as long on both axes
  std::vector<Line> roads = {};  // of a map, beneath the lines
  bool x_log = false, y_log = false;
  std::vector<Band> bands = {};
  std::optional<Mark> x_mark = std::nullopt;
};

}  // namespace maploop::web
