#include "tools/web/page.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/command/html_text.h"
#include "tools/web/bundle.h"

namespace maploop::web {
namespace {

using tools::escaped;

// Names may contain anything, including invalid UTF-8; and "</" inside a script element would end
// it.
std::string quoted(const std::string& text) {
  std::string json =
      nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) {
    json.replace(at, 1, "\\u003c");
  }
  return json;
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.7g}", value) : "null";
}

// `to_text` makes the text of an item.
template <class Items, class ToText>
std::string list(const Items& items, ToText&& to_text) {
  std::string text;
  for (const auto& item : items) (text += text.empty() ? '[' : ',') += to_text(item);
  return text.empty() ? "[]" : text + ']';
}

std::string array(const std::vector<double>& values) {
  return list(values, number);
}

const char* name_of(Line::Look look) {
  switch (look) {
    case Line::Look::solid:
      return "solid";
    case Line::Look::dashed:
      return "dashed";
    case Line::Look::steps:
      return "steps";
    case Line::Look::points:
      return "points";
  }
  return "";
}

std::string line_json(const Line& line) {
  return fmt::format(R"({{"name":{},"x":{},"y":{},"look":"{}"}})", quoted(line.name), array(line.x),
                     array(line.y), name_of(line.look));
}

std::string band_json(const Band& band) {
  return fmt::format(R"({{"name":{},"x":{},"low":{},"high":{}}})", quoted(band.name), array(band.x),
                     array(band.low), array(band.high));
}

}  // namespace

std::string to_json(const Plot& plot) {
  std::string text =
      fmt::format(R"({{"title":{},"x_label":{},"y_label":{},"lines":{},"bands":{},"roads":{},)"
                  R"("equal_axes":{},"x_log":{},"y_log":{})",
                  quoted(plot.title), quoted(plot.x_label), quoted(plot.y_label),
                  list(plot.lines, line_json), list(plot.bands, band_json),
                  list(plot.roads, line_json), plot.equal_axes, plot.x_log, plot.y_log);
  if (plot.x_mark) {
    text += fmt::format(R"(,"x_mark":{{"value":{},"name":{}}})", number(plot.x_mark->value),
                        quoted(plot.x_mark->name));
  }
  return text + "}";
}

std::string table(const Row& heading, const std::vector<Row>& rows) {
  std::string html = "<div class=\"wide\"><table>\n<tr>";
  for (const std::string& cell : heading) html += "<th>" + escaped(cell) + "</th>";
  html += "</tr>\n";
  for (const Row& row : rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += "<td>" + escaped(cell) + "</td>";
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

Page::Page(std::string_view heading) : heading_(escaped(heading)) {}

Page& Page::add(std::string_view html) {
  body_ += html;
  return *this;
}

Page& Page::add(const Plot& plot) {
  const std::string why = page_script().empty() ? "No picture: this maploop was built without npm."
                                                : "This picture needs JavaScript.";
  body_ += "<figure data-plot=\"" + std::to_string(plot_count_) + "\"" +
           (plot.equal_axes ? " class=\"map\"" : "") + "><figcaption>" + escaped(plot.title) +
           "</figcaption><div class=\"without\">" + why + "</div></figure>\n";
  plots_ += (plot_count_++ > 0 ? ",\n" : "") + to_json(plot);
  return *this;
}

Page& Page::add(const std::vector<Plot>& plots) {
  body_ += "<div class=\"plots\">\n";
  for (const Plot& plot : plots) add(plot);
  body_ += "</div>\n";
  return *this;
}

std::string Page::text() const {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         heading_ + "</title>\n<style>" + std::string(page_style()) +
         "</style></head><body>\n<h1>" + heading_ + "</h1>\n" + body_ +
         "<script type=\"application/json\" id=\"plots\">[" + plots_ + "]</script>\n<script>" +
         std::string(page_script()) + "</script>\n</body></html>\n";
}

}  // namespace maploop::web
