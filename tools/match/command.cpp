// maploop match: a recorded track on the roads it was driven on.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapmatch/match_history.h"
#include "tools/command/commands.h"
#include "tools/command/match_input_options.h"
#include "tools/command/option_checks.h"
#include "tools/match/driven_route.h"
#include "tools/match/match_output.h"
#include "tools/match/match_score.h"

namespace maploop::tools {
namespace {

constexpr double longest_lag = 10.0;  // s; METHOD.md tells why

struct MatchOptions : MatchInputOptions {
  std::filesystem::path track_file, csv, geojson, gpx, html, route, labels;
  double lag = 0.0;    // s
  bool whole = false;  // by the fixes of the longest lag
};

void print_summary(const match::MatchedTrack& track, const mapmatch::RoadNetwork& network,
                   std::vector<double>& microseconds) {
  std::map<std::string_view, std::size_t> phases;
  std::size_t matched = 0;
  for (const mapmatch::MatchResult& r : track.results) {
    if (r.refusal != mapmatch::FixRefusal::none) continue;
    ++phases[to_string(r.phase)];
    matched += r.on_road ? 1 : 0;
  }
  std::cout << track.fixes.size() << " fixes, " << matched << " on a road\n";
  for (const auto& [phase, count] : phases) std::cout << "  " << phase << ": " << count << '\n';
  for (const auto& [reason, count] : match::unused_fixes(track, network))
    std::cout << "  not used: " << count << ", " << reason << '\n';
  std::sort(microseconds.begin(), microseconds.end());
  const auto last = static_cast<double>(microseconds.size() - 1);
  const auto percentile = [&](double share) {
    return microseconds[static_cast<std::size_t>(share * last)];
  };
  std::cout << "time a fix: median " << percentile(0.5) << " us, p99 " << percentile(0.99)
            << " us, largest " << microseconds.back() << " us\n";
}

void print_score(const match::MatchedTrack& track, const mapmatch::RoadNetwork& network,
                 const std::filesystem::path& labels) {
  std::vector<match::MatchedFix> matched;
  std::vector<std::size_t> rows;
  for (const mapmatch::MatchResult& r : track.results) {
    rows.push_back(matched.size());
    matched.push_back(match::matched_fix(r, network));
  }
  match::MatchScore score;
  auto driven = match::read_labels(labels);
  match::SegmentLinks(network).look_up(driven);
  score.add(matched, rows, driven);
  std::cout << match::to_text(score);
}

int match_track(const MatchOptions& options) {
  const mapmatch::RoadNetwork network = options.network();
  const mapmatch::RuleBases rules = options.rule_bases();
  match::MatchedTrack track;
  track.name = options.track_file.filename().string();
  track.fixes = options.track(options.track_file);
  mapmatch::Matcher matcher(network, rules, options.parameters());
  mapmatch::MatchHistory history(network);
  const double lag = options.whole ? longest_lag : options.lag;
  std::vector<double> microseconds;
  for (const mapmatch::VehicleFix& fix : track.fixes) {
    const auto start = std::chrono::steady_clock::now();
    const mapmatch::MatchResult& result = matcher.add(fix);
    microseconds.push_back(1e6 * to_seconds(std::chrono::steady_clock::now() - start));
    track.results.push_back(result);
    if (lag > 0.0) history.add(result, matcher);
  }
  if (lag > 0.0) track.results = history.judged_after(from_seconds(lag));
  print_summary(track, network, microseconds);
  if (const auto why = match::why_unusable(track, network)) throw std::runtime_error(*why);
  if (!options.csv.empty()) match::write_match_csv(options.csv, track, network);
  if (!options.geojson.empty()) match::write_match_geojson(options.geojson, track, network);
  if (!options.gpx.empty()) match::write_match_gpx(options.gpx, track, network);
  if (!options.route.empty()) match::write_route(options.route, track, network);
  if (!options.html.empty()) match::write_match_html(options.html, track, network, rules);
  if (!options.labels.empty()) print_score(track, network, options.labels);
  return 0;
}

}  // namespace

void add_match(CLI::App& app, Command& command) {
  auto options = std::make_shared<MatchOptions>();
  CLI::App* sub = app.add_subcommand("match",
                                     "Find the roads that a recorded track was driven on, fix by "
                                     "fix as if live, or by later fixes, "
                                     "too (--lag, --whole)");
  add_map_argument(*sub, *options);
  sub->add_option("TRACK", options->track_file,
                  "CSV with columns t, lat, lon and what else is known (sigma or cov_ee, cov_en, "
                  "cov_nn in m; speed in m/s, azimuth_deg, yaw_rate in rad/s, hdop, visual_speed, "
                  "visual_azimuth_deg; OXTS's names, "
                  "too), GPX, NMEA, TUM or an LCM log (NAV_STATE, or GNSS_FIX); plain or .gz")
      ->required();
  sub->add_option("--csv", options->csv, "Write one line a fix to this file")
      ->check(writable_file());
  sub->add_option("--geojson", options->geojson, "The same as GeoJSON, with reasons")
      ->check(writable_file());
  sub->add_option("--gpx", options->gpx, "Write the matched positions as GPX")
      ->check(writable_file());
  sub->add_option(
         "--route", options->route,
         "Write every link that was driven, also those between two fixes, to this file, in "
         "the form of OSRM's match service (JSON)")
      ->check(writable_file());
  sub->add_option("--lag", options->lag,
                  "Judge each fix by the fixes of so many seconds after it, too")
      ->check(number_in(0.0, longest_lag))
      ->capture_default_str();
  sub->add_flag("--whole", options->whole, "The same with the longest lag, 10 s");
  sub->add_option("--html", options->html, "Write a page with map, streets, reasons and doubts")
      ->check(writable_file());
  add_match_input_options(*sub, *options);
  sub->add_option("--labels", options->labels,
                  "CSV of the links really driven (frame,way_id,node_a,node_b,conf; plain or .gz; "
                  "frame: number of TRACK's row, from 0): print the share that is right");
  sub->footer(
      "Examples:\n"
      "    maploop match town.osm.pbf track.gpx --html match.html  # with reasons\n"
      "    maploop match town.net run.lcmlog --csv matched.csv     # of a recorded run\n"
      "    maploop match town.net track.gpx --whole --route route.json");
  sub->callback([options, &command] { command = [options] { return match_track(*options); }; });
}

}  // namespace maploop::tools
