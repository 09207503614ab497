// The page of a profile.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runtime/core/histogram.h"
#include "tools/profile/profile.h"
#include "tools/web/html.h"

namespace maploop::profile {
namespace {

using web::escaped;
using Names = std::vector<std::string>;

struct Curve {
  const char* name;
  HistogramData histogram;
};

HistogramData sum(const HistogramData& a, const HistogramData& b) {
  runtime::Histogram all, other;
  all.merge(a);
  other.merge(b);
  all.merge(other);
  return all.data();
}

// Draws the share of values longer than a time.
web::Line line_of(const Curve& curve) {
  web::Line line{curve.name, {}, {}, web::Line::Look::steps};
  const HistogramData& h = curve.histogram;
  std::uint64_t longer = h.above_range;
  for (const auto& bucket : h.buckets) longer += bucket.count;
  const double share = 100.0 / static_cast<double>(longer);
  for (const auto& bucket : h.buckets) {
    line.add(to_milliseconds(std::max(bucket.lowest, Duration(1))),
             share * static_cast<double>(longer));
    longer -= bucket.count;
  }
  if (!line.x.empty() && h.max > Duration::zero())
    line.add(std::max(to_milliseconds(h.max), line.x.back()), share);
  return line;
}

// Adds a plot with both axes logarithmic, unless it is empty. `deadline` 0: none.
void add_plot(std::vector<web::Plot>& plots, const std::string& title,
              const std::vector<Curve>& curves, Duration deadline) {
  web::Plot plot{title, "ms", "% that took longer"};
  plot.x_log = plot.y_log = true;
  for (const Curve& curve : curves) {
    if (!curve.histogram.buckets.empty()) plot.lines.push_back(line_of(curve));
  }
  if (deadline > Duration::zero()) plot.x_mark = web::Mark{to_milliseconds(deadline), "deadline"};
  if (!plot.lines.empty()) plots.push_back(std::move(plot));
}

std::vector<web::Plot> distributions(const Profile& p) {
  std::vector<web::Plot> plots;
  const auto add_parts = [&](std::vector<Curve>& curves, const std::string& thread) {
    if (const auto* s = find(p.execution, thread)) curves.push_back({"execution", s->histogram});
    if (const auto* s = find(p.wake_up, thread)) curves.push_back({"wake-up", s->histogram});
    if (const auto* s = find(p.period_jitter, thread)) curves.push_back({"jitter", s->histogram});
  };
  for (const auto* latencies : {&p.threads, &p.paths}) {
    for (const Latency& l : *latencies) {
      std::vector<Curve> curves{{"latency", l.histogram}};
      if (l.hidden > 0) curves.push_back({"corrected", sum(l.histogram, l.omitted)});
      if (latencies == &p.threads) add_parts(curves, l.name);
      add_plot(plots, l.name, curves, p.virtual_time() ? Duration::zero() : l.deadline);
    }
  }
  for (const ThreadHealth& t : p.health.threads) {
    if (find(p.threads, t.name) != nullptr) continue;
    std::vector<Curve> curves;
    add_parts(curves, t.name);
    add_plot(plots, t.name, curves, Duration::zero());
  }
  return plots;
}

std::string latency_table(const Profile& p) {
  const web::Columns<Latency> judged = judgement(p.virtual_time());
  const web::Row heading =
      web::joined({web::headings(percentiles), web::headings(judged), {"guilty"}});
  const auto missed = std::find(heading.begin(), heading.end(), "missed") - heading.begin();
  std::vector<web::Row> rows;
  for (const auto* latencies : {&p.threads, &p.paths}) {
    for (const Latency& l : *latencies) {
      web::Row& row = rows.emplace_back(web::joined(
          {web::cells<LatencySummary>(percentiles, l), web::cells(judged, l), {l.guilty}}));
      for (std::string& cell : row) cell = escaped(cell);
      if (l.misses == 0 || p.virtual_time()) continue;
      std::string& cell = row[static_cast<std::size_t>(missed)];
      cell = fmt::format("<b class=\"missed\">{}</b>", cell);
    }
  }
  return web::table_of_html(heading, rows);
}

// A part of a bar; lengths are in ms.
struct BarPart {
  std::string paint;  // a colour of CSS
  std::string name;
  double length = 0.0;
};

// Draws a bar whose full width is `longest`, with a mark at the deadline, if any.
std::string bar(const std::vector<BarPart>& parts, double longest, double deadline = 0.0) {
  std::string html = "<div class=\"bar\">";
  for (const BarPart& part : parts) {
    html += fmt::format("<i style=\"width:{:.2f}%;background:{}\" title=\"{}: {:.3f} ms\"></i>",
                        100.0 * part.length / longest, part.paint, escaped(part.name), part.length);
  }
  if (deadline > 0.0) {
    html += fmt::format("<b style=\"left:{:.2f}%\" title=\"deadline\"></b>",
                        100.0 * deadline / longest);
  }
  return html + "</div>";
}

// Returns the colour of a part; a new name is added.
std::string colour(const std::string& part, Names& names) {
  constexpr std::size_t colours = 8;
  const auto found = std::find(names.begin(), names.end(), part);
  const auto index = static_cast<std::size_t>(found - names.begin());
  if (found == names.end()) names.push_back(part);
  return fmt::format("var(--series-{})", 1 + index % colours);
}

// The part that nothing else explains is the time that the graph allows.
std::string miss_bar(const WorstMiss& w, Names& names, double longest) {
  double rest = to_milliseconds(w.miss.latency);
  std::vector<BarPart> parts{{"var(--line)", "as the graph allows", 0.0}};
  for (const MissedDeadline::Part& part : w.miss.parts) {
    const double ms = std::max(0.0, to_milliseconds(part.lasted));
    rest -= ms;
    parts.push_back({colour(part.name, names), part.name, ms});
  }
  parts.front().length = std::max(0.0, rest);
  return bar(parts, longest, to_milliseconds(w.deadline));
}

std::string miss_bars(std::vector<WorstMiss> worst, Time end) {
  std::sort(worst.begin(), worst.end(),
            [](const auto& a, const auto& b) { return a.miss.stamp < b.miss.stamp; });
  double longest = 1e-3;
  for (const WorstMiss& w : worst) {
    longest = std::max({longest, to_milliseconds(w.miss.latency), to_milliseconds(w.deadline)});
  }
  Names names;
  std::vector<web::Row> rows;
  rows.reserve(worst.size());
  for (const WorstMiss& w : worst) {
    rows.push_back({escaped(w.of), web::figure(to_seconds(end - w.miss.stamp), 2),
                    web::figure(to_milliseconds(w.miss.latency), 1), miss_bar(w, names, longest)});
  }
  std::string keys = "<div class=\"keys\">";
  for (const std::string& name : Names(names)) {
    keys += "<span style=\"--key:" + colour(name, names) + "\">" + escaped(name) + "</span>";
  }
  return keys + "</div>\n" + web::table_of_html({"missed by", "s before the end", "ms", ""}, rows);
}

std::string worst_misses(const Profile& p) {
  const std::string heading = web::heading("Worst misses");
  if (p.virtual_time()) return heading + web::paragraph(no_deadlines);
  if (p.worst.empty()) return heading + web::paragraph("No deadline was missed.");
  return heading +
         web::paragraph(
             "In the order of the drive, from release (of a path: from the stamp) to result; the "
             "dashed mark is the deadline. Parts of a path are what each took beyond what the "
             "graph allows it (grey).") +
         miss_bars(p.worst, p.stamp);
}

void add_ticks(web::Page& page, const Profile& p, const nlohmann::json& ticks) {
  page.add(web::heading("Any tick"));
  if (ticks.is_null()) {
    page.add(
        "<p class=\"empty\">A trace of the run shows here what each thread did in any of its "
        "ticks: record it with 'maploop replay DRIVE --record run.lcmlog --trace run.json', and "
        "add '--trace run.json' to 'maploop profile'.</p>");
    return;
  }
  page.add(web::paragraph(
      std::string("From the release of a sample to the state that contains it. The guilty part is "
                  "the one that took longest beyond its median.") +
      (p.virtual_time() ? std::string(" ") + no_deadlines : "")));
  page.add_place("ticks", ticks);
}

}  // namespace

void add_latencies(web::Page& page, const Profile& p) {
  page.add(latency_table(p) + worst_misses(p));
}

void add_distributions(web::Page& page, const Profile& p) {
  page.add(web::heading("Distributions") +
           web::paragraph("The share of all that took longer than a time: lower and further left "
                          "is better. Corrected: with the waits that stalls of the data clock "
                          "hid."))
      .add(distributions(p));
}

void add_processor_time(web::Page& page, const Profile& p) {
  std::vector<web::Row> rows;
  for (const ProcessorTime& t : processor_time(p.health)) {
    rows.push_back(
        {escaped(t.name), web::figure(t.seconds, 3), web::figure(t.percent, 2),
         bar({{"var(--series-1)", t.name, 1e3 * t.seconds}}, 1e3 * std::max(p.health.cpu, 1e-9))});
  }
  page.add(web::heading("Processor time") +
           web::table_of_html({"thread", "s", "% of one processor", ""}, rows));
}

std::string to_html(const Profile& p, const std::string& source, const nlohmann::json& ticks) {
  web::Page page("Profile of " + source);
  page.add(web::paragraph(fmt::format(
      "The run up to {} UTC (of the data), {:.1f} s on this machine, {:.0f} % of one processor.",
      format_time(p.stamp).substr(0, 23), p.health.elapsed,
      100.0 * p.health.cpu / std::max(p.health.elapsed, 1e-9))));
  page.add_contents();
  add_latencies(page, p);
  add_ticks(page, p, ticks);
  add_distributions(page, p);
  add_processor_time(page, p);
  return page.text();
}

}  // namespace maploop::profile
