// maploop match: recorded tracks on the roads they were driven on.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/command/commands.h"
#include "tools/command/match_input_options.h"
#include "tools/command/option_checks.h"
#include "tools/command/output_check.h"
#include "tools/match/driven_route.h"
#include "tools/match/match_output.h"
#include "tools/match/match_score.h"
#include "tools/match/route_score.h"
#include "tools/match/track_matching.h"

namespace maploop::tools {
namespace {

constexpr double longest_lag = 10.0;  // s; METHOD.md tells why

struct MatchOptions : MatchInputOptions {
  std::vector<std::filesystem::path> tracks;
  std::filesystem::path csv, geojson, gpx, html, route, route_geojson, route_gpx;
  std::filesystem::path labels;
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
  if (!driven.empty() && driven.rbegin()->first >= track.fixes.size()) {
    std::cerr << "maploop: " << labels.string() << " numbers rows up to " << driven.rbegin()->first
              << ", and the track has " << track.fixes.size()
              << ": are they the labels of this track?\n";
  }
  match::SegmentLinks(network).look_up(driven);
  score.add(matched, rows, driven);
  const match::RouteScore route = match::score_route(track, rows, driven, network);
  std::cout << match::to_text(score)
            << fmt::format("route: {:.2f} % of {:.0f} m driven are right, {:.2f} % are too much\n",
                           100.0 * route.right_share(), route.driven,
                           100.0 * route.too_much_share());
}

std::vector<match::TrackOutput> outputs(const MatchOptions& options,
                                        const mapmatch::RoadNetwork& network,
                                        const mapmatch::RuleBases& rules) {
  using File = const std::filesystem::path&;
  using match::MatchedTrack;
  std::vector<match::TrackOutput> outputs;
  const auto add = [&](File where, const char* ending, auto write) {
    if (where.empty()) return;
    outputs.push_back({where, ending, [&network, write](File file, const MatchedTrack& track) {
                         write(file, track, network);
                       }});
  };
  add(options.csv, ".csv", match::write_match_csv);
  add(options.geojson, ".geojson", match::write_match_geojson);
  add(options.gpx, ".gpx", match::write_match_gpx);
  add(options.route, ".route.json", match::write_route);
  add(options.route_geojson, ".route.geojson", match::write_route_geojson);
  add(options.route_gpx, ".route.gpx", match::write_route_gpx);
  add(options.html, ".html", [&rules](File file, const MatchedTrack& track, const auto& roads) {
    match::write_match_html(file, track, roads, rules);
  });
  return outputs;
}

// Results of one track go to a file each, those of several to a folder each.
void check_options(const MatchOptions& o) {
  const bool many = o.tracks.size() > 1;
  if (many && !o.labels.empty())
    throw CLI::ValidationError("--labels", "they belong to one track: give one TRACK");
  for (const std::filesystem::path* where :
       {&o.csv, &o.geojson, &o.gpx, &o.route, &o.route_geojson, &o.route_gpx, &o.html}) {
    if (where->empty()) continue;
    std::string name = where->string();
    if (!many) {
      if (const std::string error = writable_file()(name); !error.empty())
        throw CLI::ValidationError(error);
    } else if (std::filesystem::exists(*where) && !std::filesystem::is_directory(*where)) {
      throw CLI::ValidationError(name, "it is a file; results of several tracks go to a folder");
    }
  }
}

int match_tracks(const MatchOptions& options) {
  const mapmatch::RoadNetwork network = options.network(options.tracks);
  if (network.left_hand_traffic() != network.one_way_checks().left_hand_traffic()) {
    std::cerr << "warning: most opposite carriageways of the map are those of traffic on the other "
                 "side; is --side-of-road right?\n";
  }
  const mapmatch::RuleBases rules = options.rule_bases();
  const mapmatch::MatchParameters parameters = options.parameters();
  const match::TrackMatching matching{network, rules, parameters,
                                      from_seconds(options.whole ? longest_lag : options.lag)};
  const auto outputs = tools::outputs(options, network, rules);
  if (options.tracks.size() > 1) {
    match::match_tracks(
        options.tracks, [&](const auto& file) { return options.track(file); }, matching, outputs);
    return 0;
  }
  const std::filesystem::path& file = options.tracks.front();
  std::vector<double> microseconds;
  const match::MatchedTrack track =
      matching.match(options.track(file), file.filename().string(), &microseconds);
  print_summary(track, network, microseconds);
  if (const auto why = match::why_unusable(track, network)) throw std::runtime_error(*why);
  for (const match::TrackOutput& output : outputs) output.write(output.folder, track);
  if (!options.labels.empty()) print_score(track, network, options.labels);
  return 0;
}

}  // namespace

void add_match(CLI::App& app, Command& command) {
  auto options = std::make_shared<MatchOptions>();
  CLI::App* sub = app.add_subcommand("match",
                                     "Find the roads that recorded tracks were driven on, fix by "
                                     "fix as if live, or by later fixes, "
                                     "too (--lag, --whole)");
  add_map_argument(*sub, *options);
  sub->add_option("TRACK", options->tracks,
                  "CSV with columns t, lat, lon and what else is known (sigma or cov_ee, cov_en, "
                  "cov_nn in m; speed in m/s, azimuth_deg, yaw_rate in rad/s, hdop, visual_speed, "
                  "visual_azimuth_deg; OXTS's names, "
                  "too), GPX, NMEA, TUM or an LCM log (NAV_STATE, or GNSS_FIX); plain or .gz. Of "
                  "several tracks, what is written below is a folder with a file for each")
      ->required();
  sub->add_option("--csv", options->csv, "Write one line a fix to this file")
      ->check(output_place());
  sub->add_option("--geojson", options->geojson, "The same as GeoJSON, with reasons")
      ->check(output_place());
  sub->add_option("--gpx", options->gpx, "Write the matched positions as GPX")
      ->check(output_place());
  sub->add_option(
         "--route", options->route,
         "Write every link that was driven, also those between two fixes, to this file, in "
         "the form of OSRM's match service (JSON)")
      ->check(output_place());
  sub->add_option("--route-geojson", options->route_geojson,
                  "The same as GeoJSON, a line for each link")
      ->check(output_place());
  sub->add_option("--route-gpx", options->route_gpx, "The same as GPX")->check(output_place());
  sub->add_option("--html", options->html, "Write a page with map, streets, reasons and doubts")
      ->check(output_place());
  sub->add_option("--lag", options->lag,
                  "Judge each fix by the fixes of so many seconds after it, too")
      ->check(number_in(0.0, longest_lag))
      ->capture_default_str();
  sub->add_flag("--whole", options->whole, "The same with the longest lag, 10 s");
  add_match_input_options(*sub, *options);
  sub->add_option("--labels", options->labels,
                  "CSV of the links really driven (frame,way_id,node_a,node_b,conf; plain or .gz; "
                  "frame: number of TRACK's row, from 0): print the share that is right");
  sub->callback([options, &command] {
    check_options(*options);
    command = [options] { return match_tracks(*options); };
  });
}

}  // namespace maploop::tools
