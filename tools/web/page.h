// Pages in one file that need nothing but a browser: text, tables, and pictures to zoom into.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/web/plot.h"

namespace maploop::web {

// The text and the tables of a page are plain HTML; its pictures are drawn by the script inside it.
// Where maploop was built without npm there is no script, and each picture's place says so.
class Page {
 public:
  // `heading` is plain text.
  explicit Page(std::string_view heading);

  // Text that must be HTML already (tools/html_text.h).
  Page& add(std::string_view html);
  Page& add(const Plot& plot);
  // Side by side where there is room.
  Page& add(const std::vector<Plot>& plots);

  std::string text() const;

 private:
  std::string heading_, body_;
  std::string plots_;  // JSON, without its brackets
  int plot_count_ = 0;
};

using Row = std::vector<std::string>;

// HTML of a table that can be moved sideways where it is wider than the screen; texts are plain.
std::string table(const Row& heading, const std::vector<Row>& rows);

// As JSON, seven digits of each number.
std::string to_json(const Plot& plot);

}  // namespace maploop::web
