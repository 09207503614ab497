// The tables and pictures of the map's experiment.
#include <algorithm>
#include <cmath>

#include "msgs/named_enum.h"
#include "tools/experiment/map_experiment.h"
#include "tools/experiment/table.h"
#include "tools/match/road_lines.h"
#include "tools/web/page.h"

namespace maploop::experiments {
namespace {

std::string percent(const match::Tally& tally) {
  return tally.fixes == 0 ? "-" : number(100.0 * tally.share(), 2);
}

std::string fault_of(const MapResult& r) {
  return r.setup.fault.empty() ? "-" : r.setup.fault;
}

Row row_of(const MapResult& r) {
  const fusion_score::Errors& e = without_gnss(r);
  const bool matched = r.setup.mode != MapMode::none;
  const bool closed = r.setup.mode == MapMode::tight || r.setup.mode == MapMode::hard_reset;
  return {r.setup.sequence,
          r.setup.configuration,
          r.setup.unit(),
          r.setup.outages,
          fault_of(r),
          std::string(to_string(r.setup.mode)),
          std::to_string(r.setup.seed),
          number(e.distance, 0),
          number(e.rmse, 2),
          number(e.max, 2),
          number(e.rmse_percent(), 3),
          number(e.azimuth_rms, 2),
          number(e.nees_mean, 2),
          matched ? percent(r.match.certain) : "-",
          matched ? percent(r.match.all) : "-",
          closed ? std::to_string(r.reasons[0]) : "-",
          closed ? std::to_string(r.gated) : "-",
          closed ? std::to_string(r.restorations) : "-"};
}

Table runs(const std::vector<MapResult>& results) {
  Table table{"Time without GNSS",
              {"sequence", "configuration", "unit", "no GNSS", "map fault", "mode", "seed", "m",
               "rmse m", "max m", "rmse % of way", "az rms deg", "NEES (2)", "link conf=1 %",
               "link %", "fed back", "gated", "restored"},
              {}};
  for (const MapResult& r : results) table.rows.push_back(row_of(r));
  return table;
}

// All sequences and seeds of a mode together.
Table pooled(const std::vector<MapResult>& results) {
  struct Sum {
    double squares = 0.0, samples = 0.0, nees = 0.0, max = 0.0;
    match::Tally certain, all;
  };
  Groups<Sum> sums;
  for (const MapResult& r : results) {
    Sum& sum = sums[{r.setup.configuration, r.setup.unit(), r.setup.outages, fault_of(r),
                     std::string(to_string(r.setup.mode))}];
    const fusion_score::Errors& e = without_gnss(r);
    const auto n =
        static_cast<double>(r.match.all.fixes > 0 ? r.match.all.fixes : r.samples.size());
    sum.squares += n * e.rmse * e.rmse;
    sum.nees += n * e.nees_mean;
    sum.samples += n;
    sum.max = std::max(sum.max, e.max);
    sum.certain += r.match.certain;
    sum.all += r.match.all;
  }
  Table table{"All sequences together",
              {"configuration", "unit", "no GNSS", "map fault", "mode", "rmse m", "max m",
               "NEES (2)", "link conf=1 %", "link %"},
              {}};
  for (const auto& [cells, sum] : sums) {
    Row& row = table.rows.emplace_back(cells);
    row.insert(row.end(), {number(std::sqrt(sum.squares / std::max(1.0, sum.samples)), 2),
                           number(sum.max, 2), number(sum.nees / std::max(1.0, sum.samples), 2),
                           percent(sum.certain), percent(sum.all)});
  }
  return table;
}

// The cells that are the same for all modes and map faults of a drive.
Row drive_of(const MapCase& c) {
  return {c.sequence, c.configuration, c.unit(), c.outages, std::to_string(c.seed)};
}

// The feedback's error against twice that of the filter without the map at the same moment, or,
// where that one happens to be small, against twice what it says of itself.
Table against_map_free(const std::vector<MapResult>& results) {
  Table table{"Against the filter without the map, moment by moment",
              {"sequence", "unit", "no GNSS", "map fault", "mode", "seed", "map-free rmse m",
               "max m", "rmse m", "max m", "worse than twice, % of time", "by at most m",
               "P(link) on the missing way", "else", "restored"},
              {}};
  for (const MapResult& r : results) {
    if (r.setup.mode != MapMode::tight && r.setup.mode != MapMode::hard_reset) continue;
    const auto free = std::find_if(results.begin(), results.end(), [&](const MapResult& o) {
      return o.setup.mode == MapMode::none && drive_of(o.setup) == drive_of(r.setup);
    });
    if (free == results.end()) continue;
    const Comparison c = compare(r, *free);
    const fusion_score::Errors& f = without_gnss(*free);
    const fusion_score::Errors& e = without_gnss(r);
    table.rows.push_back({r.setup.sequence, r.setup.unit(), r.setup.outages, fault_of(r),
                          std::string(to_string(r.setup.mode)), std::to_string(r.setup.seed),
                          number(f.rmse, 2), number(f.max, 2), number(e.rmse, 2), number(e.max, 2),
                          number(100.0 * c.worse, 1), number(c.worst_excess, 2),
                          r.missing != 0 ? number(c.probability_on_missing, 2) : "-",
                          number(c.probability, 2), std::to_string(r.restorations)});
  }
  return table;
}

Table reasons(const std::vector<MapResult>& results) {
  Table table{"Why nothing was fed back, % of all fixes", {"sequence", "mode", "seed"}, {}};
  for (std::size_t i = 0; i < count_of<FeedbackReason>; ++i)
    table.heading.emplace_back(to_string(static_cast<FeedbackReason>(i)));
  for (const MapResult& r : results) {
    if (r.setup.mode != MapMode::tight || r.setup.outages != results.front().setup.outages ||
        !r.setup.fault.empty() || r.setup.seed != 1)
      continue;
    double all = 0.0;
    for (const std::size_t n : r.reasons) all += static_cast<double>(n);
    Row row{r.setup.sequence, std::string(to_string(r.setup.mode)), std::to_string(r.setup.seed)};
    for (const std::size_t n : r.reasons)
      row.push_back(number(100.0 * static_cast<double>(n) / std::max(1.0, all), 1));
    table.rows.push_back(row);
  }
  return table;
}

// The ways seen from above, the errors and P(link) against time, of one drive in all its modes.
void add_plots(const MapSetting& setting, const std::vector<const MapResult*>& drive,
               std::vector<web::Plot>& plots) {
  const MapCase& c = drive.front()->setup;
  const std::string title = "Sequence " + c.sequence + ", " + c.configuration +
                            (c.mems ? ", mems" : "") + ", no GNSS " + c.outages +
                            (c.fault.empty() ? "" : ", " + c.fault);
  web::Line truth{"reference", {}, {}};
  for (const MapSample& s : drive.front()->samples) {
    truth.x.push_back(s.truth.x());
    truth.y.push_back(s.truth.y());
  }
  constexpr double beside = 200.0;  // m
  web::Plot map{title, "east, m", "north, m", {truth}, true};
  map.roads = match::road_lines(setting.roads->network, drive.front()->origin, map.lines, beside);
  web::Plot errors{title, "s", "horizontal error, m"};
  web::Plot links{title, "s", "P(link)"};
  for (const MapResult* r : drive) {
    web::Line way{std::string(to_string(r->setup.mode)), {}, {}}, error = way, link = way;
    for (const MapSample& s : r->samples) {
      way.x.push_back(s.truth.x() + s.error.x());
      way.y.push_back(s.truth.y() + s.error.y());
      error.x.push_back(s.time);
      error.y.push_back(s.error.norm());
      link.x.push_back(s.time);
      link.y.push_back(s.probability);
    }
    map.lines.push_back(way);
    errors.lines.push_back(error);
    if (r->setup.mode != MapMode::none) links.lines.push_back(link);
  }
  plots.push_back(map);
  plots.push_back(errors);
  if (!links.lines.empty()) plots.push_back(links);
}

}  // namespace

Comparison compare(const MapResult& aided, const MapResult& free) {
  Comparison c;
  double count = 0.0, on_missing = 0.0, elsewhere = 0.0;
  std::size_t k = 0;
  for (const MapSample& a : aided.samples) {
    while (k < free.samples.size() && free.samples[k].time < a.time - 1e-6) ++k;
    if (k == free.samples.size()) break;
    const MapSample& f = free.samples[k];
    if (std::abs(f.time - a.time) > 1e-6) continue;
    const double excess = a.error.norm() - 2.0 * std::max(f.error.norm(), f.sigma);
    c.worse += excess > 0.0 ? 1.0 : 0.0;
    c.worst_excess = std::max(c.worst_excess, excess);
    count += 1.0;
    (a.on_missing ? c.probability_on_missing : c.probability) += a.probability;
    (a.on_missing ? on_missing : elsewhere) += 1.0;
  }
  c.worse /= std::max(1.0, count);
  c.probability_on_missing /= std::max(1.0, on_missing);
  c.probability /= std::max(1.0, elsewhere);
  return c;
}

std::string to_text(const std::vector<MapResult>& results) {
  return as_text(runs(results)) + as_text(against_map_free(results)) + as_text(pooled(results));
}

std::string to_html(const MapSetting& setting, const std::vector<MapResult>& results) {
  std::vector<web::Plot> plots;
  Groups<std::vector<const MapResult*>> drives;
  for (const MapResult& r : results) {
    if (r.setup.seed != 1) continue;
    Row drive = drive_of(r.setup);
    drive.push_back(r.setup.fault);
    drives[drive].push_back(&r);
  }
  for (const auto& [cells, modes] : drives) add_plots(setting, modes, plots);
  return web::Page("The map in the loop")
      .add(as_html(pooled(results)))
      .add(as_html(runs(results)))
      .add(as_html(against_map_free(results)))
      .add(as_html(reasons(results)))
      .add(plots)
      .text();
}

}  // namespace maploop::experiments
