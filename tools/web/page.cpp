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

std::string why_without(std::string_view script) {
  return script.empty() ? "No picture: this maploop was built without npm."
                        : "This picture needs JavaScript.";
}

std::string embedded(std::string_view id, const std::string& data) {
  return "<script type=\"application/json\" id=\"" + std::string(id) + "\">" + data + "</script>\n";
}

}  // namespace

json with_seven_digits(const std::vector<double>& values) {
  json list = json::array();
  for (const double value : values) {
    list.push_back(std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr));
  }
  return list;
}

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

Page::Page(std::string_view heading, Script script) : script_(script), heading_(escaped(heading)) {}

Page& Page::add(std::string_view html) {
  body_ += html;
  return *this;
}

Page& Page::add(const Plot& plot) {
  body_ += "<figure data-plot=\"" + std::to_string(plot_count_) + "\"" +
           (plot.equal_axes ? " class=\"map\"" : "") + "><figcaption>" + escaped(plot.title) +
           "</figcaption><div class=\"without\">" + why_without(page_script()) +
           "</div></figure>\n";
  plots_ += (plot_count_++ > 0 ? ",\n" : "") + to_json(plot);
  return *this;
}

Page& Page::add(const std::vector<Plot>& plots) {
  body_ += "<div class=\"plots\">\n";
  for (const Plot& plot : plots) add(plot);
  body_ += "</div>\n";
  return *this;
}

Page& Page::add_place(std::string_view id, const json& data) {
  body_ += "<div id=\"" + std::string(id) + "\"><div class=\"without\">" +
           why_without(comparison_script()) + "</div></div>\n" +
           embedded(std::string(id) + "-data", script_json(data));
  return *this;
}

std::string Page::text() const {
  const bool plots = script_ == Script::plots;
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         heading_ + "</title>\n<style>" + std::string(plots ? page_style() : comparison_style()) +
         "</style></head><body><main>\n<h1>" + heading_ + "</h1>\n" + body_ + "</main>\n" +
         embedded("plots", '[' + plots_ + ']') + "<script>" +
         std::string(plots ? page_script() : comparison_script()) + "</script>\n</body></html>\n";
}

}  // namespace maploop::web
