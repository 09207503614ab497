#include <fmt/format.h>
#include <algorithm>

#include "runtime/core/histogram.h"
#include "tools/command/html_text.h"
#include "tools/profile/latency_plot.h"
#include "tools/profile/profile.h"
#include "tools/profile/profile_page.h"

namespace maploop::profile {
namespace {

using tools::escaped;

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

void append_row(std::string& html, const Latency& latency, bool virtual_time) {
  const LatencySummary& s = latency.recorded;
  html += fmt::format("<tr><td>{}</td><td>{}</td>", escaped(s.name), s.count);
  for (const Duration d : {s.p50, s.p90, s.p99, s.p999, s.max}) {
    html += fmt::format("<td>{:.3f}</td>", to_milliseconds(d));
  }
  if (virtual_time) {
    html += "<td>-</td><td>-</td>";
  } else {
    html += fmt::format("<td>{:.0f}</td><td{}>{}</td>", to_milliseconds(s.deadline),
                        s.misses > 0 ? " class=\"missed\"" : "", s.misses);
  }
  if (latency.omitted > 0) {
    html += fmt::format("<td>{:.3f}</td>", to_milliseconds(latency.corrected_p999));
  } else {
    html += "<td>-</td>";
  }
  html += "<td>" + escaped(s.guilty) + "</td></tr>\n";
}

void append_tables(std::string& html, const Profile& p) {
  html +=
      "<div class=\"wide\"><table><tr><th>ms</th><th>count</th><th>p50</th><th>p90</th><th>p99</th>"
      "<th>p99.9</th><th>max</th><th>deadline</th><th>missed</th><th>p99.9 corrected</th>"
      "<th>guilty</th></tr>\n";
  for (const auto* latencies : {&p.threads, &p.paths}) {
    for (const Latency& l : *latencies) append_row(html, l, p.virtual_time());
  }
  html += "</table></div>\n";
}

std::vector<web::Plot> distributions(const Profile& p) {
  std::vector<web::Plot> plots;
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
  const auto deadline_of = [&](const Latency& l) {
    return p.virtual_time() ? Duration::zero() : l.recorded.deadline;
  };
  for (const Latency& l : p.threads) {
    plots.push_back(
        latency_plot(l.recorded.name, with_parts(l.recorded.name, of_latency(l)), deadline_of(l)));
  }
  for (const Latency& l : p.paths) {
    plots.push_back(latency_plot(l.recorded.name, of_latency(l), deadline_of(l)));
  }
  for (const ThreadHealth& t : p.health.threads) {
    const bool shown = std::any_of(p.threads.begin(), p.threads.end(),
                                   [&](const Latency& l) { return l.recorded.name == t.name; });
    const std::vector<Curve> curves = with_parts(t.name, {});
    if (!shown) plots.push_back(latency_plot(t.name, curves, {}));
  }
  std::erase_if(plots, [](const web::Plot& plot) { return plot.lines.empty(); });
  return plots;
}

void append_misses(std::string& html, const Profile& p) {
  html += "<h2>Worst misses</h2>";
  if (p.virtual_time()) {
    html += std::string("<p>") + no_deadlines + "</p>\n";
    return;
  }
  if (p.worst.empty()) {
    html += "<p>No deadline was missed.</p>\n";
    return;
  }
  html +=
      "<p>In the order of the drive, from release (of a path: from the stamp) to result; the "
      "dashed mark is the deadline. Parts of a path are what each took beyond what the graph "
      "allows "
      "it (grey).</p>\n" +
      miss_bars(p.worst, p.stamp);
}

void append_processor_time(std::string& html, const Health& health) {
  html +=
      "<h2>Processor time</h2><div class=\"wide\"><table><tr><th>thread</th><th>s</th>"
      "<th>% of one processor</th><th></th></tr>\n";
  const double elapsed = std::max(health.elapsed, 1e-9);
  const double all = std::max(health.cpu, 1e-9);
  const auto row = [&](const std::string& name, double seconds) {
    html += fmt::format(
        "<tr><td>{}</td><td>{:.3f}</td><td>{:.2f}</td><td style=\"width:40%\"><div class=\"bar\">"
        "<i style=\"width:{:.1f}%;background:var(--c0)\"></i></div></td></tr>\n",
        escaped(name), seconds, 100.0 * seconds / elapsed,
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

void add_latencies(web::Page& page, const Profile& p) {
  std::string html;
  append_tables(html, p);
  append_misses(html, p);
  html +=
      "<h2>Distributions</h2><p>The share of all that took longer than a time: lower and further "
      "left is better. Corrected: with the waits that stalls of the data clock hid.</p>\n";
  page.add(html).add(distributions(p));
}

void add_processor_time(web::Page& page, const Profile& p) {
  std::string html;
  append_processor_time(html, p.health);
  page.add(html);
}

std::string to_html(const Profile& p, const std::string& source) {
  web::Page page("Profile of " + source);
  std::string line = fmt::format(
      "<p>The run up to {} UTC (of the data), {:.1f} s on this machine, {:.0f} % of one "
      "processor.</p>\n",
      format_time(p.stamp).substr(0, 23), p.health.elapsed,
      100.0 * p.health.cpu / std::max(p.health.elapsed, 1e-9));
  page.add(line);
  add_latencies(page, p);
  add_processor_time(page, p);
  return page.text();
}

}  // namespace maploop::profile
