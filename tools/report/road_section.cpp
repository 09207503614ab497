#include <array>

#include "tools/report/sections.h"
#include "tools/web/html.h"
#include "tools/web/table.h"

namespace maploop::report {
namespace {

using tools::RoadMoment;
using web::figure;
using web::Line;
using web::paragraph;
using web::Plot;
using Matches = std::map<Time, RoadMoment>;

constexpr std::array phases{MatchPhase::initial, MatchPhase::along_link, MatchPhase::at_junction,
                            MatchPhase::off_road};

std::string phase_table(const Matches& matches) {
  std::array<std::size_t, phases.size()> counts{};
  for (const auto& [stamp, moment] : matches) ++counts[static_cast<std::size_t>(moment.phase)];
  std::vector<web::Row> rows;
  for (const MatchPhase phase : phases) {
    const std::size_t n = counts[static_cast<std::size_t>(phase)];
    const double share = static_cast<double>(n) / static_cast<double>(matches.size());
    rows.push_back({std::string(to_string(phase)), std::to_string(n), figure(100.0 * share, 1)});
  }
  return web::table({"phase", "matches", "%"}, rows);
}

web::Row tally_row(const char* name, const match::Tally& t) {
  return {name, std::to_string(t.fixes), figure(100.0 * t.share(), 2),
          figure(100.0 * t.coverage(), 2), std::to_string(t.wrong())};
}

std::string identified(const match::MatchScore& score) {
  std::vector<web::Row> rows{tally_row("all labels", score.all)};
  if (score.certain.fixes > 0) rows.push_back(tally_row("certain labels", score.certain));
  return paragraph(
             "The matched road against the one driven, at the moments with a label; what was not "
             "matched counts as wrong.") +
         web::table({"", "moments", "right road, %", "coverage, %", "wrong"}, rows);
}

Plot reliability(const match::Reliability& r) {
  Plot plot{"Reliability of P(link)", "P(link) said", "share that is right"};
  Line line{"right", {}, {}, Line::Look::points};
  for (std::size_t k = 0; k < r.fixes.size(); ++k) {
    if (r.fixes[k] == 0) continue;
    const auto n = static_cast<double>(r.fixes[k]);
    line.add(r.p_sum[k] / n, static_cast<double>(r.right[k]) / n);
  }
  plot.lines = {std::move(line), {"as said", {0.0, 1.0}, {0.0, 1.0}, Line::Look::dashed}};
  return plot;
}

Plot probability(const Scene& scene) {
  Plot plot{"P(link)", "s", "1", {{"of the matched link", {}, {}}}};
  plot.over_time = true;
  for (const auto& [stamp, moment] : scene.report.pass.matches) {
    plot.lines[0].add(scene.second(stamp), moment.on_road ? moment.matched.p_link : unknown);
  }
  return plot;
}

}  // namespace

void add_roads(web::Page& page, const Scene& scene) {
  const Matches& matches = scene.report.pass.matches;
  if (matches.empty()) return;
  page.add(web::heading(road_heading));
  std::vector<Plot> plots{probability(scene)};
  if (const auto& links = scene.report.result.links; links && links->all.fixes > 0) {
    page.add(identified(*links));
    plots.push_back(reliability(links->reliability));
  } else {
    page.add(
        paragraph("How much is right is not known: the recording does not say which links "
                  "were driven."));
  }
  page.add(phase_table(matches)).add(plots);
}

}  // namespace maploop::report
