#include "tools/evaluation/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/html_text.h"

namespace maploop::evaluation {
namespace {

using tools::escaped;

constexpr double kWidth = 640, kHeight = 400;  // px, all
constexpr double kLeft = 60, kRight = 20, kTop = 30, kBottom = 45;
constexpr std::array kColours = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf"};

std::string number(double value, const char* format = "%.2f") {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

// The values an axis shows, and the pixels they are drawn at.
struct Axis {
  double low = 0.0, high = 1.0;
  double first_px = 0.0, last_px = 0.0;

  double px(double value) const {
    return first_px + (value - low) / (high - low) * (last_px - first_px);
  }
  bool shows(double value) const { return value >= low && value <= high; }
  double per_px() const { return (high - low) / std::abs(last_px - first_px); }
  void widen_to(double units_per_px) {
    const double middle = 0.5 * (low + high);
    const double half = 0.5 * units_per_px * std::abs(last_px - first_px);
    low = middle - half;
    high = middle + half;
  }
  // 1, 2 or 5 times a power of ten, about six in all.
  double tick() const {
    const double rough = (high - low) / 6.0;
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 5.0})
      if (factor * power >= rough) return factor * power;
    return 10.0 * power;
  }
};

Axis axis_of(const Plot& plot, std::vector<double> Line::*values, double first_px, double last_px) {
  Axis axis{0.0, 1.0, first_px, last_px};
  bool any = false;
  for (const Line& line : plot.lines)
    for (const double value : line.*values) {
      if (!std::isfinite(value)) continue;
      axis.low = any ? std::min(axis.low, value) : value;
      axis.high = any ? std::max(axis.high, value) : value;
      any = true;
    }
  if (!(axis.high - axis.low > 1e-12)) axis.high = axis.low + 1.0;
  return axis;
}

std::string text_at(double x, double y, const std::string& anchor, const std::string& text) {
  return "<text x='" + number(x) + "' y='" + number(y) + "' text-anchor='" + anchor + "'>" +
         escaped(text) + "</text>\n";
}

std::string segment(double x1, double y1, double x2, double y2) {
  return "<line x1='" + number(x1) + "' y1='" + number(y1) + "' x2='" + number(x2) + "' y2='" +
         number(y2) + "' stroke='#ddd'/>\n";
}

std::string grid(const Axis& x, const Axis& y) {
  std::string svg;
  for (double v = std::ceil(x.low / x.tick()) * x.tick(); v <= x.high; v += x.tick())
    svg += segment(x.px(v), y.first_px, x.px(v), y.last_px) +
           text_at(x.px(v), y.first_px + 16, "middle", number(v + 0.0, "%.4g"));
  for (double v = std::ceil(y.low / y.tick()) * y.tick(); v <= y.high; v += y.tick())
    svg += segment(x.first_px, y.px(v), x.last_px, y.px(v)) +
           text_at(x.first_px - 6, y.px(v) + 4, "end", number(v + 0.0, "%.4g"));
  return svg;
}

}  // namespace

std::string to_svg(const Plot& plot) {
  Axis x = axis_of(plot, &Line::x, kLeft, kWidth - kRight);
  Axis y = axis_of(plot, &Line::y, kHeight - kBottom, kTop);
  if (plot.equal_axes) {
    const double scale = std::max(x.per_px(), y.per_px());
    x.widen_to(scale);
    y.widen_to(scale);
  }
  std::string svg = "<svg xmlns='http://www.w3.org/2000/svg' width='" + number(kWidth, "%.0f") +
                    "' height='" + number(kHeight, "%.0f") +
                    "' font-family='sans-serif' font-size='12'>\n";
  svg += text_at(kWidth / 2, 18, "middle", plot.title) + grid(x, y);
  svg += text_at((kLeft + kWidth - kRight) / 2, kHeight - 8, "middle", plot.x_label);
  svg += "<text transform='translate(14," + number(kHeight / 2) +
         ") rotate(-90)' text-anchor='middle'>" + escaped(plot.y_label) + "</text>\n";
  for (const Line& line : plot.background) {
    svg += "<polyline fill='none' stroke-width='0.7' stroke='#999' points='";
    for (std::size_t k = 0; k < line.x.size(); ++k)
      if (x.shows(line.x[k]) && y.shows(line.y[k]))
        svg += number(x.px(line.x[k])) + "," + number(y.px(line.y[k])) + " ";
    svg += "'/>\n";
  }
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    const Line& line = plot.lines[i];
    const std::string colour = kColours[i % kColours.size()];
    svg += "<polyline fill='none' stroke-width='1.5' stroke='" + colour + "' points='";
    for (std::size_t k = 0; k < line.x.size(); ++k)
      if (std::isfinite(line.x[k]) && std::isfinite(line.y[k]))
        svg += number(x.px(line.x[k])) + "," + number(y.px(line.y[k])) + " ";
    svg += "'/>\n<g fill='" + colour + "'>" +
           text_at(kLeft + 8, kTop + 16 + 15 * static_cast<double>(i), "start", line.name) +
           "</g>\n";
  }
  return svg + "</svg>\n";
}

std::string to_page(const std::string& heading, const std::string& body,
                    const std::vector<Plot>& plots) {
  std::string page = "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><title>" +
                     escaped(heading) +
                     "</title>\n<style>body{font-family:sans-serif;margin:2em}"
                     "td,th{padding:.2em .8em;text-align:right}</style></head>\n<body><h1>" +
                     escaped(heading) + "</h1>\n" + body;
  for (const Plot& plot : plots) page += to_svg(plot);
  return page + "</body></html>\n";
}

}  // namespace maploop::evaluation
