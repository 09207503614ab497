#include "tools/web/page.h"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tools/web/bundle.h"
#include "tools/web/html.h"

namespace maploop::web {
namespace {

using nlohmann::json;

// Numbers that are not finite become null in the text of the JSON.
json with_seven_digits(const std::vector<double>& values) {
  json list = json::array();
  for (const double value : values) {
    list.push_back(std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr));
  }
  return list;
}

json json_of(const Line& line) {
  constexpr std::array looks{"solid", "dashed", "steps", "points"};
  return {{"name", line.name},
          {"x", with_seven_digits(line.x)},
          {"y", with_seven_digits(line.y)},
          {"look", looks[static_cast<std::size_t>(line.look)]}};
}

json json_of(const Band& band) {
  return {{"name", band.name},
          {"x", with_seven_digits(band.x)},
          {"low", with_seven_digits(band.low)},
          {"high", with_seven_digits(band.high)}};
}

template <class Item>
json json_of(const std::vector<Item>& items) {
  json list = json::array();
  for (const Item& item : items) list.push_back(json_of(item));
  return list;
}

}  // namespace

std::string script_json(const json& value) {
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
    text.replace(at, 1, "\\u003c");
  }
  return text;
}

std::string to_json(const Plot& plot) {
  json j{{"title", plot.title},
         {"x_label", plot.x_label},
         {"y_label", plot.y_label},
         {"lines", json_of(plot.lines)},
         {"bands", json_of(plot.bands)},
         {"roads", json_of(plot.roads)},
         {"equal_axes", plot.equal_axes},
         {"x_log", plot.x_log},
         {"y_log", plot.y_log}};
  if (plot.x_mark) j["x_mark"] = {{"value", plot.x_mark->value}, {"name", plot.x_mark->name}};
  return script_json(j);
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
