#include <algorithm>

#include "runtime/core/histogram.h"
#include "tools/html_text.h"
#include "tools/lcm_log/log_text.h"
#include "tools/profile/profile.h"
#include "tools/profile/svg_chart.h"

namespace maploop::profile {
namespace {

using lcm_log::append;
using tools::escaped;

constexpr const char* style = R"(
:root { color-scheme: light dark; --surface: #fcfcfb; --ink: #0b0b0b; --soft: #52514e; --line: #e1e0d9;
  --c0: #2a78d6; --c1: #1baf7a; --c2: #eda100; --c3: #4a3aa7; --c4: #e34948; --c5: #e87ba4;
  --c6: #eb6834; --c7: #008300; --grey: #c3c2b7; }
@media (prefers-color-scheme: dark) {
  :root { --surface: #1a1a19; --ink: #ffffff; --soft: #c3c2b7; --line: #383835;
    --c0: #3987e5; --c1: #199e70; --c2: #c98500; --c3: #9085e9; --c4: #e66767; --c5: #d55181;
    --c6: #d95926; --c7: #008300; --grey: #52514e; } }
body { background: var(--surface); color: var(--ink); font: 15px/1.5 system-ui, sans-serif;
  max-width: 1040px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.5em; margin-bottom: 0; } h2 { font-size: 1.15em; margin: 2em 0 .3em; }
p { color: var(--soft); margin: .3em 0 .8em; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; width: 100%; }
th, td { padding: .25em .5em; text-align: right; border-bottom: 1px solid var(--line); }
th { color: var(--soft); font-weight: 500; } th:first-child, td:first-child { text-align: left; }
td:first-child, td:last-child { white-space: nowrap; }
td.missed { color: var(--c4); font-weight: 600; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(380px, 1fr)); gap: 1.2em; }
svg { width: 100%; height: auto; }
svg text { font: 12px system-ui, sans-serif; fill: var(--soft); }
svg .title { font-size: 14px; font-weight: 600; fill: var(--ink); } svg .label { fill: var(--ink); }
.grid { stroke: var(--line); } .deadline { stroke: var(--ink); stroke-dasharray: 2 3; stroke-width: 1.5; }
.curve { fill: none; stroke-width: 2; stroke-linejoin: round; }
.latency { stroke: var(--c0); } .corrected { stroke: var(--c0); stroke-dasharray: 5 4; }
.execution { stroke: var(--c1); } .wake-up { stroke: var(--c2); } .jitter { stroke: var(--c3); }
.allowed { fill: var(--grey); }
.part-0 { fill: var(--c0); } .part-1 { fill: var(--c1); } .part-2 { fill: var(--c2); }
.part-3 { fill: var(--c3); } .part-4 { fill: var(--c4); } .part-5 { fill: var(--c5); }
.part-6 { fill: var(--c6); } .part-7 { fill: var(--c7); }
.key { display: inline-flex; align-items: center; gap: .4em; margin-right: 1.2em; color: var(--soft); }
.key svg { width: 22px; height: 12px; }
.meter { display: inline-block; height: .7em; border-radius: 2px; background: var(--c0); }
)";

constexpr std::size_t part_colours = 8;

double to_ms(Duration d) {
  return to_seconds(d) * 1e3;
}

HistogramData sum(const HistogramData& a, const HistogramData& b) {
  runtime::Histogram all, other;
  all.merge(a);
  other.merge(b);
  all.merge(other);
  return all.data();
}

const LatencySummary* find(const std::vector<LatencySummary>& all, const std::string& name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.name == name; });
  return found == all.end() ? nullptr : &*found;
}

void append_row(std::string& html, const LatencySummary& s, const Latency* latency) {
  append(html, "<tr><td>%s</td><td>%llu</td>", escaped(s.name).c_str(),
         static_cast<unsigned long long>(s.count));
  for (const Duration d : {s.p50, s.p90, s.p99, s.p999, s.max}) {
    append(html, "<td>%.3f</td>", to_ms(d));
  }
  if (latency != nullptr) {
    append(html, "<td>%.0f</td><td%s>%llu</td>", to_ms(s.deadline),
           s.misses > 0 ? " class=\"missed\"" : "", static_cast<unsigned long long>(s.misses));
    if (latency->omitted > 0) {
      append(html, "<td>%.3f</td>", to_ms(latency->corrected_p999));
    } else {
      html += "<td>-</td>";
    }
    html += "<td>" + escaped(s.guilty) + "</td>";
  }
  html += "</tr>\n";
}

void append_tables(std::string& html, const Profile& p) {
  html +=
      "<div class=\"wide\"><table><tr><th>ms</th><th>count</th><th>p50</th><th>p90</th><th>p99</th>"
      "<th>p99.9</th><th>max</th><th>deadline</th><th>missed</th><th>p99.9 corrected</th>"
      "<th>guilty</th></tr>\n";
  for (const auto* latencies : {&p.threads, &p.paths}) {
    for (const Latency& l : *latencies) append_row(html, l.recorded, &l);
  }
  html += "</table></div>\n";
}

std::string key(const std::string& shape, const std::string& name) {
  return "<span class=\"key\"><svg viewBox=\"0 0 22 12\">" + shape + "</svg>" + escaped(name) +
         "</span>";
}

void append_charts(std::string& html, const Profile& p) {
  html +=
      "<h2>Distributions</h2><p>The share of all that took longer than a time: lower and further "
      "left is better. Corrected: with the waits that stalls of the data clock hid.</p><div>";
  for (const char* role : {"latency", "corrected", "execution", "wake-up", "jitter"}) {
    html += key(std::string("<path class=\"curve ") + role + "\" d=\"M1 6H21\"/>", role);
  }
  html += "</div>\n<div class=\"charts\">\n";
  const auto with_parts = [&](const std::string& thread, std::vector<Curve> curves) {
    if (const auto* s = find(p.execution, thread)) curves.push_back({"execution", s->histogram});
    if (const auto* s = find(p.wake_up, thread)) curves.push_back({"wake-up", s->histogram});
    if (const auto* s = find(p.period_jitter, thread)) curves.push_back({"jitter", s->histogram});
    return curves;
  };
  const auto of_latency = [](const Latency& l) {
    std::vector<Curve> curves{{"latency", l.recorded.histogram}};
    if (l.omitted > 0) {
      curves.push_back({"corrected", sum(l.recorded.histogram, l.recorded.omitted)});
    }
    return curves;
  };
  for (const Latency& l : p.threads) {
    html += latency_chart(l.recorded.name, with_parts(l.recorded.name, of_latency(l)),
                          l.recorded.deadline);
  }
  for (const Latency& l : p.paths) {
    html += latency_chart(l.recorded.name, of_latency(l), l.recorded.deadline);
  }
  for (const ThreadHealth& t : p.health.threads) {
    const bool shown = std::any_of(p.threads.begin(), p.threads.end(),
                                   [&](const Latency& l) { return l.recorded.name == t.name; });
    const std::vector<Curve> curves = with_parts(t.name, {});
    if (!shown && !curves.empty()) html += latency_chart(t.name, curves, {});
  }
  html += "</div>\n";
}

void append_misses(std::string& html, const Profile& p) {
  html += "<h2>Worst misses</h2>";
  if (p.worst.empty()) {
    html += "<p>No deadline was missed.</p>\n";
    return;
  }
  std::vector<std::string> names;
  for (const WorstMiss& w : p.worst) {
    for (const MissedDeadline::Part& part : w.miss.parts) {
      if (std::find(names.begin(), names.end(), part.name) == names.end()) {
        names.push_back(part.name);
      }
    }
  }
  html +=
      "<p>In the order of the drive, from release (of a path: from the stamp) to result; the "
      "dashed "
      "mark is the deadline. Parts of a path are what each took beyond what the graph allows "
      "it.</p><div>";
  for (std::size_t i = 0; i < std::min(names.size(), part_colours); ++i) {
    html +=
        key("<rect class=\"part-" + std::to_string(i) + "\" width=\"20\" height=\"12\" rx=\"2\"/>",
            names[i]);
  }
  html += "</div>\n<div class=\"wide\">" + miss_chart(p.worst, names, p.stamp) + "</div>\n";
}

void append_processor_time(std::string& html, const Health& health) {
  html +=
      "<h2>Processor time</h2><div class=\"wide\"><table><tr><th>thread</th><th>s</th>"
      "<th>% of one processor</th><th></th></tr>\n";
  const double elapsed = std::max(health.elapsed, 1e-9);
  const double all = std::max(health.cpu, 1e-9);
  const auto row = [&](const std::string& name, double seconds) {
    append(html,
           "<tr><td>%s</td><td>%.3f</td><td>%.2f</td><td style=\"width:40%%;text-align:left\">"
           "<span class=\"meter\" style=\"width:%.1f%%\"></span></td></tr>\n",
           escaped(name).c_str(), seconds, 100.0 * seconds / elapsed,
           std::clamp(100.0 * seconds / all, 0.0, 100.0));
  };
  double rest = health.cpu;
  for (const ThreadHealth& t : health.threads) {
    row(t.name, t.cpu);
    rest -= t.cpu;
  }
  row("loaders and the rest", std::max(rest, 0.0));
  row("process", health.cpu);
  html += "</table></div>\n";
}

}  // namespace

std::string to_html(const Profile& p, const std::string& source) {
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Profile "
      "of " +
      escaped(source) + "</title>\n<style>" + style + "</style></head><body>\n";
  html += "<h1>Profile of " + escaped(source) + "</h1>\n";
  append(html,
         "<p>The run up to %s UTC (of the data), %.1f s on this machine, %.0f %% of one "
         "processor.</p>\n",
         format_time(p.stamp).substr(0, 23).c_str(), p.health.elapsed,
         100.0 * p.health.cpu / std::max(p.health.elapsed, 1e-9));
  append_tables(html, p);
  append_misses(html, p);
  append_charts(html, p);
  append_processor_time(html, p.health);
  return html + "</body></html>\n";
}

}  // namespace maploop::profile
