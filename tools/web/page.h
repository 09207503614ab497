// Writes pages in one file that only need a browser: text, tables, and zoomable pictures.
#pragma once

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

  // `html` must already be HTML (tools/command/html_text.h).
  Page& add(std::string_view html);
  Page& add(const Plot& plot);
  // Adds the pictures side by side if there is room.
  Page& add(const std::vector<Plot>& plots);

  std::string text() const;

 private:
  std::string heading_, body_;
  std::string plots_;  // JSON, without its brackets
  int plot_count_ = 0;
};

using Row = std::vector<std::string>;

// Returns the HTML of a table that scrolls sideways if it is wider than the screen; texts are
// plain.
std::string table(const Row& heading, const std::vector<Row>& rows);

// Returns the plot as JSON, with seven digits of each number.
std::string to_json(const Plot& plot);

}  // namespace maploop::web
