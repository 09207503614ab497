#include "tools/profile/svg_chart.h"

#include <algorithm>
#include <cmath>

#include "tools/html_text.h"
#include "tools/lcm_log/log_text.h"

namespace maploop::profile {
namespace {

using lcm_log::append;
using tools::escaped;

double to_ms(Duration d) {
  return to_seconds(d) * 1e3;
}

// 1e-3: "1 µs", 10: "10 ms", 1e3: "1 s".
std::string time_label(double ms) {
  std::string text;
  if (ms < 0.9e-3) {
    append(text, "%g ns", ms * 1e6);
  } else if (ms < 0.9) {
    append(text, "%g µs", ms * 1e3);
  } else if (ms < 900.0) {
    append(text, "%g ms", ms);
  } else {
    append(text, "%g s", ms * 1e-3);
  }
  return text;
}

// Whole decades.
struct LogAxis {
  int from, to;           // powers of ten
  double at_from, at_to;  // where these are in the picture

  double operator()(double value) const {
    const double along = (std::log10(value) - from) / (to - from);
    return at_from + std::clamp(along, 0.0, 1.0) * (at_to - at_from);
  }
};

std::uint64_t count_of(const HistogramData& h) {
  std::uint64_t count = h.above_range;
  for (const auto& bucket : h.buckets) count += bucket.count;
  return count;
}

std::string curve_path(const HistogramData& h, const LogAxis& x, const LogAxis& y) {
  const auto all = static_cast<double>(count_of(h));
  std::string path;
  append(path, "M%.1f %.1f", x.at_from, y.at_to);
  std::uint64_t longer = count_of(h);
  for (const auto& bucket : h.buckets) {
    longer -= bucket.count;
    append(path, "H%.1f", x(to_ms(std::max(bucket.lowest, Duration(1)))));
    append(path, "V%.1f", longer == 0 ? y.at_from : y(static_cast<double>(longer) / all));
  }
  return path;
}

// The decades that hold all curves and the deadline.
LogAxis time_axis(const std::vector<Curve>& curves, Duration deadline, double left, double right) {
  double least = 1e9, most = 1e-3;
  if (deadline > Duration::zero()) least = most = to_ms(deadline);
  for (const Curve& curve : curves) {
    if (curve.histogram.buckets.empty()) continue;
    const double first = to_ms(curve.histogram.buckets.front().lowest);
    least = std::min(least, std::max(first, 1e-4));
    most = std::max(most, to_ms(curve.histogram.max));
  }
  const int from = static_cast<int>(std::floor(std::log10(least)));
  const int to = static_cast<int>(std::floor(std::log10(most) + 1e-9)) + 1;
  return {from, std::max(to, from + 1), left, right};
}

}  // namespace

std::string latency_chart(const std::string& title, const std::vector<Curve>& curves,
                          Duration deadline) {
  constexpr double width = 420, height = 260, left = 52, right = 398, top = 44, bottom = 228;
  std::uint64_t most = 1;
  for (const Curve& curve : curves) most = std::max(most, count_of(curve.histogram));
  const int decades = std::max(1, static_cast<int>(std::ceil(std::log10(most))));
  const LogAxis x = time_axis(curves, deadline, left, right);
  const LogAxis y{-decades, 0, bottom, top};

  std::string svg;
  append(
      svg,
      "<svg viewBox=\"0 0 %g %g\" role=\"img\"><text class=\"title\" x=\"%g\" y=\"16\">%s</text>\n",
      width, height, left, escaped(title).c_str());
  for (int power = y.from; power <= 0; ++power) {
    const double at = y(std::pow(10.0, power));
    append(svg, "<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>", left, at, right);
    append(svg, "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%g %%</text>\n",
           left - 6, at + 4, 100.0 * std::pow(10.0, power));
  }
  for (int power = x.from; power <= x.to; ++power) {
    const double at = x(std::pow(10.0, power));
    append(svg, "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>", at, top, bottom);
    append(svg, "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%s</text>\n", at,
           bottom + 16, time_label(std::pow(10.0, power)).c_str());
  }
  for (const Curve& curve : curves) {
    if (curve.histogram.buckets.empty()) continue;
    svg += "<path class=\"curve " + curve.role + "\" d=\"" + curve_path(curve.histogram, x, y) +
           "\"><title>" + escaped(title) + ": " + curve.role + "</title></path>\n";
  }
  if (deadline > Duration::zero()) {
    const double at = x(to_ms(deadline));
    append(svg, "<path class=\"deadline\" d=\"M%.1f %.1fV%.1f\"/>", at, top, bottom);
    append(svg,
           "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">deadline %s</text>\n",
           std::clamp(at, left + 40.0, right - 40.0), top - 5, time_label(to_ms(deadline)).c_str());
  }
  return svg + "</svg>\n";
}

std::string miss_chart(std::vector<WorstMiss> worst, const std::vector<std::string>& names,
                       Time end) {
  constexpr double width = 860, left = 300, right = 790, top = 28, row = 26, bar = 14;
  std::sort(worst.begin(), worst.end(),
            [](const auto& a, const auto& b) { return a.miss.stamp < b.miss.stamp; });
  double longest = 1e-3;
  for (const WorstMiss& w : worst) longest = std::max(longest, to_ms(w.miss.latency));
  const double bottom = top + row * static_cast<double>(worst.size());
  const double scale = (right - left) / longest;

  std::string svg;
  append(svg, "<svg viewBox=\"0 0 %g %g\" role=\"img\">\n", width, bottom + 24);
  const double step = std::pow(10.0, std::floor(std::log10(longest)));
  const double every = longest / step > 5.0 ? 2.0 * step : longest / step > 2.0 ? step : step / 4.0;
  for (double ms = 0.0; ms <= longest; ms += every) {
    append(svg, "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>", left + ms * scale, top - 6, bottom);
    append(svg, "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%g ms</text>\n",
           left + ms * scale, bottom + 16, ms);
  }
  double y = top;
  for (const WorstMiss& w : worst) {
    append(svg, "<text class=\"label\" x=\"0\" y=\"%.1f\">%s</text>", y + bar - 3,
           escaped(w.of).c_str());
    append(svg,
           "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">%.2f s before the "
           "end</text>\n",
           left - 8, y + bar - 3, to_seconds(end - w.miss.stamp));
    double known = 0.0;
    for (const auto& part : w.miss.parts) known += std::max(0.0, to_ms(part.lasted));
    const double allowed = std::max(0.0, to_ms(w.miss.latency) - known);
    double x = left;
    const auto draw = [&](const std::string& role, const std::string& name, double ms) {
      if (ms * scale < 0.05) return;
      append(svg,
             "<rect class=\"%s\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%g\" "
             "rx=\"2\"><title>%s: %.3f ms</title></rect>",
             role.c_str(), x, y, std::max(ms * scale - 1.0, 0.6), bar, escaped(name).c_str(), ms);
      x += ms * scale;
    };
    draw("allowed", "as the graph allows", allowed);
    for (const auto& part : w.miss.parts) {
      const auto found = std::find(names.begin(), names.end(), part.name);
      draw("part-" + std::to_string(found - names.begin()), part.name,
           std::max(0.0, to_ms(part.lasted)));
    }
    const double deadline = left + to_ms(w.deadline) * scale;
    append(svg, "<path class=\"deadline\" d=\"M%.1f %.1fV%.1f\"/>", deadline, y - 4, y + bar + 4);
    append(svg, "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\">%.1f ms</text>\n",
           left + to_ms(w.miss.latency) * scale + 5, y + bar - 3, to_ms(w.miss.latency));
    y += row;
  }
  return svg + "</svg>\n";
}

}  // namespace maploop::profile
