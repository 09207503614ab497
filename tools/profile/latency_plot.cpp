#include "tools/profile/latency_plot.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "tools/command/html_text.h"

namespace maploop::profile {
namespace {

using tools::escaped;

constexpr std::size_t part_colours = 8;

std::uint64_t count_of(const HistogramData& h) {
  std::uint64_t count = h.above_range;
  for (const auto& bucket : h.buckets) count += bucket.count;
  return count;
}

web::Line line_of(const Curve& curve) {
  web::Line line{curve.name, {}, {}, web::Line::Look::steps};
  const HistogramData& h = curve.histogram;
  const auto all = static_cast<double>(count_of(h));
  std::uint64_t longer = count_of(h);
  for (const auto& bucket : h.buckets) {
    line.x.push_back(to_milliseconds(std::max(bucket.lowest, Duration(1))));
    line.y.push_back(100.0 * static_cast<double>(longer) / all);
    longer -= bucket.count;
  }
  if (!line.x.empty() && h.max > Duration::zero()) {
    line.x.push_back(std::max(to_milliseconds(h.max), line.x.back()));
    line.y.push_back(100.0 / all);
  }
  return line;
}

std::vector<std::string> part_names(const std::vector<WorstMiss>& worst) {
  std::vector<std::string> names;
  for (const WorstMiss& w : worst) {
    for (const MissedDeadline::Part& part : w.miss.parts) {
      if (std::find(names.begin(), names.end(), part.name) == names.end()) {
        names.push_back(part.name);
      }
    }
  }
  return names;
}

std::string colour(std::size_t part) {
  return "var(--c" + std::to_string(part % part_colours) + ")";
}

std::string bar(const WorstMiss& w, const std::vector<std::string>& names, double longest) {
  double known = 0.0;
  for (const auto& part : w.miss.parts) known += std::max(0.0, to_milliseconds(part.lasted));
  std::string html = "<div class=\"bar\">";
  const auto draw = [&](const std::string& paint, const std::string& name, double ms) {
    html += fmt::format("<i style=\"width:{:.2f}%;background:{}\" title=\"{}: {:.3f} ms\"></i>",
                        100.0 * ms / longest, paint, escaped(name), ms);
  };
  draw("var(--grey)", "as the graph allows",
       std::max(0.0, to_milliseconds(w.miss.latency) - known));
  for (const auto& part : w.miss.parts) {
    const auto found = std::find(names.begin(), names.end(), part.name);
    draw(colour(static_cast<std::size_t>(found - names.begin())), part.name,
         std::max(0.0, to_milliseconds(part.lasted)));
  }
  html += fmt::format("<b style=\"left:{:.2f}%\" title=\"deadline\"></b></div>",
                      100.0 * to_milliseconds(w.deadline) / longest);
  return html;
}

}  // namespace

web::Plot latency_plot(const std::string& title, const std::vector<Curve>& curves,
                       Duration deadline) {
  web::Plot plot{title, "ms", "% that took longer"};
  plot.x_log = plot.y_log = true;
  for (const Curve& curve : curves) {
    if (!curve.histogram.buckets.empty()) plot.lines.push_back(line_of(curve));
  }
  if (deadline > Duration::zero()) plot.x_mark = web::Mark{to_milliseconds(deadline), "deadline"};
  return plot;
}

std::string miss_bars(std::vector<WorstMiss> worst, Time end) {
  const std::vector<std::string> names = part_names(worst);
  std::sort(worst.begin(), worst.end(),
            [](const auto& a, const auto& b) { return a.miss.stamp < b.miss.stamp; });
  double longest = 1e-3;
  for (const WorstMiss& w : worst) {
    longest = std::max({longest, to_milliseconds(w.miss.latency), to_milliseconds(w.deadline)});
  }
  std::string html = "<div class=\"keys\">";
  for (std::size_t i = 0; i < names.size(); ++i) {
    html += "<span style=\"--key:" + colour(i) + "\">" + escaped(names[i]) + "</span>";
  }
  html +=
      "</div>\n<div class=\"wide\"><table><tr><th>missed by</th><th>s before the end</th>"
      "<th>ms</th><th style=\"width:60%\"></th></tr>\n";
  for (const WorstMiss& w : worst) {
    html += fmt::format("<tr><td>{}</td><td>{:.2f}</td><td>{:.1f}</td><td>", escaped(w.of),
                        to_seconds(end - w.miss.stamp), to_milliseconds(w.miss.latency));
    html += bar(w, names, longest) + "</td></tr>\n";
  }
  return html + "</table></div>\n";
}

}  // namespace maploop::profile
