#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/evaluate/text_file.h"
#include "tools/match/decision_data.h"
#include "tools/match/driven_streets.h"
#include "tools/match/map_doubts.h"
#include "tools/match/match_summary.h"
#include "tools/web/html.h"
#include "tools/web/page.h"
#include "tools/web/table.h"

namespace maploop::match {
namespace {

using web::Line;
using web::Plot;

std::string percent(std::size_t part, std::size_t all) {
  return all == 0
             ? "-"
             : web::figure(100.0 * static_cast<double>(part) / static_cast<double>(all), 1, " %");
}

std::string summary_table(const MatchedTrack& track, const mapmatch::RoadNetwork& network,
                          const std::vector<DrivenStreet>& streets) {
  const MatchSummary s = summary(track, network);
  const auto row = [&](const std::string& name, std::size_t count, std::size_t all) {
    return web::Row{name, std::to_string(count), percent(count, all)};
  };
  double length = 0.0;
  for (const DrivenStreet& street : streets) length += street.length;
  std::vector<web::Row> rows{{"fixes", std::to_string(s.fixes), ""},
                             row("matched to a road", s.matched, s.fixes),
                             row("off road", s.off_road, s.fixes)};
  for (const auto& [reason, count] : s.unused)
    rows.push_back(row("not used: " + reason, count, s.fixes));
  rows.push_back(row("matched, P below 0.9", s.doubtful, s.matched));
  rows.push_back({"driven on roads", web::figure(1e-3 * length, 3, " km"), ""});
  return web::table({}, rows);
}

std::string street_table(const std::vector<DrivenStreet>& streets) {
  if (streets.empty()) return "<p class=\"empty\">No fix was matched to a road.</p>\n";
  std::vector<web::Row> rows;
  rows.reserve(streets.size());
  for (const DrivenStreet& s : streets) {
    rows.push_back({web::escaped(s.name),
                    web::time_button(s.from, s.to, web::figure(s.from, 1, " s")),
                    web::figure(s.to, 1, " s"), web::figure(s.length, 0, " m"),
                    web::figure(s.probability, 3)});
  }
  return web::table_of_html({"street", "from", "to", "length", "mean P"}, rows);
}

// The values over time that are plotted, of the fixes that were used.
struct Series {
  std::vector<double> second, probability, distance, sigma, speed;
  bool has_speeds = false;  // of the track itself, else the speed is that of its positions
};

Series series_of(const MatchedTrack& track, const mapmatch::RoadNetwork& network) {
  Series s;
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  const std::vector<std::size_t> used = track.used();
  for (const std::size_t i : used) s.has_speeds |= std::isfinite(track.fixes[i].speed);
  for (const std::size_t i : used) {
    const mapmatch::VehicleFix& fix = track.fixes[i];
    const mapmatch::MatchResult& r = track.results[i];
    const Eigen::Vector2d place = network.to_local(fix.position);
    const double second = track.second(i);
    const double of_positions =
        s.second.empty() ? mapmatch::unknown : (place - last).norm() / (second - s.second.back());
    s.second.push_back(second);
    s.probability.push_back(r.on_road ? r.probability : mapmatch::unknown);
    s.distance.push_back(r.on_road ? (r.point.position - place).norm() : mapmatch::unknown);
    s.sigma.push_back(std::sqrt(0.5 * fix.covariance.trace()));
    s.speed.push_back(3.6 * (s.has_speeds ? fix.speed : of_positions));
    last = place;
  }
  return s;
}

Line line_of(const char* name, const Series& s, const std::vector<double>& values,
             Line::Look look = Line::Look::solid) {
  const auto kept = web::thinned(values.size(), {&values});
  return {name, web::chosen(s.second, kept), web::chosen(values, kept), look};
}

std::vector<Plot> plots_of(const MatchedTrack& track, const mapmatch::RoadNetwork& network) {
  const Series s = series_of(track, network);
  std::vector<Plot> plots{
      {"Probability of the road", "s", "P", {line_of("of the matched road", s, s.probability)}},
      {"Distance to the road",
       "s",
       "m",
       {line_of("to the matched point", s, s.distance),
        line_of("sigma of the fix", s, s.sigma, Line::Look::dashed)}},
      {"Speed",
       "s",
       "km/h",
       {line_of(s.has_speeds ? "of the track" : "from its positions", s, s.speed)}}};
  for (Plot& plot : plots) plot.over_time = true;
  return plots;
}

}  // namespace

void write_match_html(const std::filesystem::path& file, const MatchedTrack& track,
                      const mapmatch::RoadNetwork& network, const mapmatch::RuleBases& rules) {
  const std::vector<DrivenStreet> streets = driven_streets(track, network);
  web::Page page("Roads driven" + (track.name.empty() ? "" : ": " + track.name));
  page.add_contents()
      .add(summary_table(track, network, streets))
      .add_timeline(map_doubts(track, network))
      .add_place("match", decision_data(track, network, rules))
      .add("<div class=\"plots lists\"><section>\n")
      .add(web::heading("Streets"))
      .add(web::paragraph("In the order in which they were driven."))
      .add(street_table(streets))
      .add("</section><section>\n")
      .add(web::heading("Doubts"))
      .add(web::paragraph("Where the drive and the map did not fit, and fixes that were not used."))
      .add_events()
      .add("</section></div>\n")
      .add(web::heading("Over time"))
      .add(plots_of(track, network));
  evaluation::write_text(file, page.text());
}

}  // namespace maploop::match
