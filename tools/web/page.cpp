#include "tools/web/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tools/web/bundle.h"
#include "tools/web/html.h"

namespace maploop::web {
namespace {

using nlohmann::json;

json json_of(const Line& line) {
  constexpr std::array looks{"solid", "dashed", "steps", "points"};
  json j{{"name", line.name},
         {"x", with_seven_digits(line.x)},
         {"y", with_seven_digits(line.y)},
         {"look", looks[static_cast<std::size_t>(line.look)]}};
  if (!line.time.empty()) j["time"] = with_seven_digits(line.time);
  return j;
}

json json_of(const Band& band) {
  return {{"name", band.name},
          {"x", with_seven_digits(band.x)},
          {"low", with_seven_digits(band.low)},
          {"high", with_seven_digits(band.high)}};
}

json json_of(const Event& event) {
  constexpr std::array levels{"note", "warning", "error"};
  return {{"from", event.from},
          {"to", event.to},
          {"level", levels[static_cast<std::size_t>(event.level)]},
          {"text", event.text},
          {"section", event.section.empty() ? "" : heading_id(event.section)}};
}

template <class Item>
json json_of(const std::vector<Item>& items) {
  json list = json::array();
  for (const Item& item : items) list.push_back(json_of(item));
  return list;
}

std::string without() {
  return std::string("<div class=\"without\">") +
         (page_script().empty() ? "No picture: this maploop was built without npm."
                                : "This picture needs JavaScript.") +
         "</div>";
}

constexpr std::string_view contents_place = "<nav class=\"contents\"></nav>\n";

// Returns links to the headings with an id.
std::string contents_of(std::string_view body) {
  constexpr std::string_view begin = "<h2 id=\"";
  std::string links = "<nav class=\"contents\" aria-label=\"Contents\">";
  for (std::size_t at = 0; (at = body.find(begin, at)) != std::string_view::npos;) {
    at += begin.size();
    const std::size_t id_end = body.find('"', at), end = body.find("</h2>", at);
    links += fmt::format("<a href=\"#{}\">{}</a> ", body.substr(at, id_end - at),
                         body.substr(id_end + 2, end - id_end - 2));
    at = end;
  }
  return links + "</nav>\n";
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
  json j{{"title", plot.title},           {"x_label", plot.x_label},
         {"y_label", plot.y_label},       {"lines", json_of(plot.lines)},
         {"bands", json_of(plot.bands)},  {"roads", json_of(plot.roads)},
         {"equal_axes", plot.equal_axes}, {"x_log", plot.x_log},
         {"y_log", plot.y_log},           {"over_time", plot.over_time},
         {"in_readout", plot.in_readout}};
  if (plot.x_mark) j["x_mark"] = {{"value", plot.x_mark->value}, {"name", plot.x_mark->name}};
  return script_json(j);
}

std::vector<std::size_t> thinned(std::size_t count,
                                 const std::vector<const std::vector<double>*>& series) {
  constexpr std::size_t stretches = 1500;
  std::vector<std::size_t> kept;
  const std::size_t length = std::max<std::size_t>(1, count / stretches);
  for (std::size_t begin = 0; begin < count; begin += length) {
    const std::size_t end = std::min(begin + length, count);
    kept.push_back(begin);
    for (const auto* values : series) {
      std::size_t low = begin, high = begin, gap = end;
      for (std::size_t i = begin; i < end; ++i) {
        const double value = (*values)[i];
        if (!std::isfinite(value)) {
          gap = std::min(gap, i);
        } else {
          if (!((*values)[low] <= value)) low = i;
          if (!((*values)[high] >= value)) high = i;
        }
      }
      kept.insert(kept.end(), {low, high});
      if (gap < end) kept.push_back(gap);
    }
  }
  if (count > 0) kept.push_back(count - 1);
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

std::vector<double> chosen(const std::vector<double>& values,
                           const std::vector<std::size_t>& kept) {
  std::vector<double> some;
  some.reserve(kept.size());
  for (const std::size_t i : kept) some.push_back(values[i]);
  return some;
}

Page::Page(std::string_view heading) : heading_(escaped(heading)) {}

Page& Page::add(std::string_view html) {
  body_ += html;
  return *this;
}

Page& Page::add(const Plot& plot) {
  body_ += "<figure data-plot=\"" + std::to_string(plot_count_) + "\"" +
           (plot.equal_axes ? " class=\"map\"" : "") + "><figcaption>" + escaped(plot.title) +
           "</figcaption>" + without() + "</figure>\n";
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
  body_ += "<div id=\"" + std::string(id) + "\">" + without() + "</div>\n" +
           embedded(std::string(id) + "-data", script_json(data));
  return *this;
}

Page& Page::add_contents() {
  return add(contents_place);
}

Page& Page::add_timeline(const std::vector<Event>& events, std::optional<double> start) {
  return add_place("timeline",
                   {{"events", json_of(events)}, {"start", start ? json(*start) : json()}});
}

Page& Page::add_overview(const std::optional<Plot>& map) {
  body_ += "<div class=\"overview\">\n";
  if (map) add(*map);
  return add("<div id=\"readout\"></div></div>\n");
}

Page& Page::add_events() {
  return add("<div id=\"events\"></div>\n");
}

std::string Page::text() const {
  std::string body = body_;
  if (const std::size_t at = body.find(contents_place); at != std::string::npos)
    body.replace(at, contents_place.size(), contents_of(body_));
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         heading_ + "</title>\n<style>" + std::string(page_style()) +
         "</style></head><body><main>\n<h1>" + heading_ + "</h1>\n" + body + "</main>\n" +
         embedded("plots", '[' + plots_ + ']') + "<script>" + std::string(page_script()) +
         "</script>\n</body></html>\n";
}

}  // namespace maploop::web
