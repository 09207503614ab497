// The contents of a picture on a page; the page's script draws it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace maploop::web {

struct Line {
  enum class Look { solid, dashed, steps, points };

  std::string name;
  std::vector<double> x = {}, y = {};  // same lengths; a value that is not finite breaks the line
  Look look = Look::solid;
  std::vector<double> time = {};  // of each place on a map, as the x of plots over time; or empty

  void add(double at_x, double at_y) {
    x.push_back(at_x);
    y.push_back(at_y);
  }
};

// A filled area between two lines.
struct Band {
  std::string name;
  std::vector<double> x, low, high;  // same lengths
};

// A marked value of x, for instance a deadline.
struct Mark {
  double value = 0.0;
  std::string name;
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<Line> lines = {};
  bool equal_axes = false;       // for maps: a metre has the same length on both axes
  std::vector<Line> roads = {};  // for maps, beneath the lines
  bool x_log = false, y_log = false;
  std::vector<Band> bands = {};
  std::optional<Mark> x_mark = std::nullopt;
  bool over_time = false;  // x is finite, increases, and follows the timeline of the page, if any
  bool in_readout = true;  // of a plot over time: its values are in the page's table at the cursor
};

// An event is at a time, or lasts for a while, on the timeline of a page.
struct Event {
  enum class Level { note, warning, error };

  double from = 0.0, to = 0.0;  // as the x of plots over time
  Level level = Level::note;
  std::string text;
  std::string section = {};  // text of the heading beneath which there is more; empty: none
};

}  // namespace maploop::web
