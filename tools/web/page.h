// Writes pages in one file that only need a browser: text, tables, and zoomable pictures.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/web/plot.h"

namespace maploop::web {

// The text and the tables of a page are plain HTML; its pictures are drawn by the script inside it.
// If maploop was built without npm there is no script, and a text in place of each picture states
// this.
class Page {
 public:
  // `heading` is plain text.
  explicit Page(std::string_view heading);

  // `html` must already be HTML (tools/web/html.h).
  Page& add(std::string_view html);
  Page& add(const Plot& plot);
  // Adds the pictures side by side if there is room.
  Page& add(const std::vector<Plot>& plots);
  // Adds an empty element for the script's pictures, which says why there is none, and the data
  // that they are made of, in an element "ID-data".
  Page& add_place(std::string_view id, const nlohmann::json& data);
  // Adds links to all headings of the page.
  Page& add_contents();
  // Adds the controls of the one cursor and stretch of time that all plots over time have, and maps
  // whose lines have times. `start`: the time of the day at x = 0, in seconds; without one times
  // are seconds.
  Page& add_timeline(const std::vector<Event>& events, std::optional<double> start = {});
  // Adds a map, if any, and beside it the table of all values at the cursor.
  Page& add_overview(const std::optional<Plot>& map);
  // Adds the list of the timeline's events.
  Page& add_events();

  std::string text() const;

 private:
  std::string heading_, body_;
  std::string plots_;  // JSON, without its brackets
  int plot_count_ = 0;
};

// Returns which of `count` values over time are drawn: all, or if there are many, of each stretch
// the first one, those with the smallest and the largest value of each series, and the first that
// is not finite, which is a gap.
std::vector<std::size_t> thinned(std::size_t count,
                                 const std::vector<const std::vector<double>*>& series);
std::vector<double> chosen(const std::vector<double>& values, const std::vector<std::size_t>& kept);

// Returns a list with seven digits of each number; those that are not finite become null.
nlohmann::json with_seven_digits(const std::vector<double>& values);

// Returns the plot as JSON, with seven digits of each number.
std::string to_json(const Plot& plot);

// Returns JSON that can stand in a script element: "</" would end the element, and "<!--" would
// hide its end. Invalid UTF-8 is replaced.
std::string script_json(const nlohmann::json& value);

}  // namespace maploop::web
