// The tables and pictures of the map's experiment with PPP.
#include <algorithm>
#include <cmath>

#include "tools/experiment/ppp_map_experiment.h"
#include "tools/web/page.h"

namespace maploop::experiments {
namespace {

constexpr double stays_below = 1.5;  // m across

std::string interval(double percent, double low, double high) {
  return number(percent, 1) + " (" + number(low, 1) + " to " + number(high, 1) + ")";
}

bool has_labels(const PppMapResult& r) {
  return std::any_of(r.parts.begin(), r.parts.end(), [](const Part& part) {
    return std::any_of(part.begin(), part.end(), [](const PppMoment& m) { return m.on_map; });
  });
}

// Of moments that move, behind the result's begin; `on`: on mapped streets, or off them.
Chosen moments_of(const PppMapResult& r, std::optional<bool> on, double useful) {
  return [from = r.from, on, useful](const PppMoment& m) {
    return m.moves && m.time >= from && m.sigma_free > useful && (!on || m.on_map == on);
  };
}

void add_row(Table& table, const PppMapResult& r, const std::string& where, const Chosen& chosen,
             double length) {
  // A whole drive is as many draws as it has such lengths.
  const std::vector<Part> parts = r.parts.size() == 1 ? cut_into(r.parts.front(), length) : r.parts;
  const Reduction across = reduction(parts, true, chosen);
  if (across.moments == 0) return;
  const Reduction level = reduction(parts, false, chosen);
  table.rows.push_back({r.group, r.name, where, std::to_string(across.parts),
                        std::to_string(across.moments), number(across.without, 3),
                        number(across.with, 3), interval(across.percent, across.low, across.high),
                        number(level.without, 3), number(level.with, 3),
                        interval(level.percent, level.low, level.high)});
}

Table error_table(const std::vector<PppMapResult>& results, const PppMapOptions& options) {
  Table table{"Root mean square errors in m with the map (tight) and without (none, loose)",
              {"drives", "case", "where", "parts", "epochs", "across without", "with",
               "less, % (95 %)", "horizontal without", "with", "less, % (95 %)"},
              {}};
  for (const PppMapResult& r : results) {
    if (has_labels(r)) {
      add_row(table, r, "mapped", moments_of(r, true, options.useful), options.length);
      add_row(table, r, "not mapped", moments_of(r, false, 0.0), options.length);
    } else {
      add_row(table, r, "all", moments_of(r, {}, options.useful), options.length);
    }
  }
  return table;
}

Table time_table(const std::vector<PppMapResult>& results) {
  Table table{"Seconds until the error across stays below " + number(stays_below, 1) +
                  " m to the end of a part",
              {"drives", "case", "without", "with", "less, % (95 %)"},
              {}};
  for (const PppMapResult& r : results) {
    if (r.parts.size() < 2) continue;
    const TimeToStay t = time_to_stay(r.parts, stays_below, r.from, moments_of(r, {}, 0.0));
    table.rows.push_back({r.group, r.name, number(t.without, 1), number(t.with, 1),
                          interval(t.percent, t.low, t.high)});
  }
  return table;
}

Table recovery_table(const std::vector<PppMapResult>& results) {
  Table table{"Ten seconds after the map paused: distance from the solution without it",
              {"drives", "case", "pauses", "forgotten", "farthest, in its standard deviations"},
              {}};
  for (const PppMapResult& r : results) {
    const Recovery recovered = recovery(r.parts);
    table.rows.push_back({r.group, r.name, std::to_string(recovered.pauses),
                          std::to_string(recovered.restorations), number(recovered.farthest, 2)});
  }
  return table;
}

// Root mean square over the parts, against time.
web::Plot against_time(const PppMapResult& r) {
  web::Plot plot{r.group + ", " + r.name,
                 "s",
                 "root mean square across, m",
                 {{"without the map", {}, {}}, {"with", {}, {}}}};
  constexpr double step = 5.0;  // s
  double last = 0.0;
  for (const Part& part : r.parts)
    if (!part.empty()) last = std::max(last, part.back().time);
  for (double t = 0.0; t <= last; t += step) {
    const Reduction at = reduction(r.parts, true, [t](const PppMoment& m) {
      return m.moves && m.time >= t && m.time < t + step;
    });
    if (at.moments == 0) continue;
    for (int i = 0; i < 2; ++i) {
      plot.lines[static_cast<std::size_t>(i)].x.push_back(t + 0.5 * step);
      plot.lines[static_cast<std::size_t>(i)].y.push_back(i == 0 ? at.without : at.with);
    }
  }
  return plot;
}

web::Plot whole_drive(const PppMapResult& r) {
  web::Plot plot{
      r.group + ", " + r.name, "s", "across, m", {{"without the map", {}, {}}, {"with", {}, {}}}};
  for (const PppMoment& m : r.parts.front()) {
    if (!m.moves) continue;
    plot.lines[0].x.push_back(m.time);
    plot.lines[0].y.push_back(m.across_free);
    plot.lines[1].x.push_back(m.time);
    plot.lines[1].y.push_back(m.across_aided);
  }
  return plot;
}

}  // namespace

std::string to_text(const std::vector<PppMapResult>& results, const PppMapOptions& options) {
  return as_text(error_table(results, options)) + as_text(time_table(results)) +
         as_text(recovery_table(results));
}

std::string to_html(const std::vector<PppMapResult>& results, const PppMapOptions& options) {
  std::vector<web::Plot> plots;
  for (const PppMapResult& r : results) {
    if (r.parts.empty()) continue;
    plots.push_back(r.parts.size() > 1 ? against_time(r) : whole_drive(r));
  }
  return web::Page("The map inside PPP")
      .add(
          "<p>Each part of a drive is one draw, its filter begun anew; the same epochs with and "
          "without the map. Loose matching feeds nothing back, so its errors are those without. "
          "Counted are epochs that move; on mapped streets, and where it is not known what is "
          "mapped, those whose standard deviation across the way without the map exceeds " +
          number(options.useful, 2) + " m.</p>")
      .add(as_html(error_table(results, options)))
      .add(as_html(time_table(results)))
      .add(as_html(recovery_table(results)))
      .add(plots)
      .text();
}

}  // namespace maploop::experiments
