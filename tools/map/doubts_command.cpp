// maploop map doubts: what drives contradict of a map.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapmatch/matcher.h"
#include "mapmatch/reasons.h"
#include "tools/command/commands.h"
#include "tools/command/match_input_options.h"
#include "tools/command/option_checks.h"
#include "tools/command/progress.h"
#include "tools/match/doubts_file.h"
#include "tools/match/match_score.h"

namespace maploop::tools {
namespace {

struct DoubtOptions : MatchInputOptions {
  std::filesystem::path output;
  std::vector<std::filesystem::path> tracks;
  double min_probability = 0.5;
};

int find_doubts(const DoubtOptions& options) {
  const mapmatch::RoadNetwork network = options.network(options.tracks);
  const mapmatch::RuleBases rules = options.rule_bases();
  const mapmatch::MatchParameters parameters = options.parameters();
  if (!parameters.paths) {
    throw std::runtime_error(
        "paths = false leaves the rules alone, which give no probabilities of a link: doubts need "
        "the paths");
  }
  match::DoubtPool pool(network);
  std::size_t fixes = 0, on_road = 0;
  Progress progress("tracks");
  std::size_t done = 0;
  for (const std::filesystem::path& file : options.tracks) {
    mapmatch::Matcher matcher(network, rules, parameters);
    std::vector<MapDoubt> doubts;
    const auto matched = match::match_track(matcher, options.track(file), {.doubts = &doubts});
    for (const MapDoubt& doubt : doubts) pool.add(doubt, file.string());
    fixes += matched.size();
    on_road += static_cast<std::size_t>(std::count_if(
        matched.begin(), matched.end(), [](const match::MatchedFix& m) { return m.way_id; }));
    progress.at(static_cast<double>(++done), static_cast<double>(options.tracks.size()));
  }
  if (on_road == 0) {
    throw std::runtime_error("no fix of the tracks is on a road of " + options.map.string() +
                             ": is it the map of this area? 'maploop match' says why");
  }
  const auto found = pool.likelier_than(options.min_probability);
  std::cout << fmt::format("{} fixes of {} tracks, {} on a road; {} doubts\n", fixes,
                           options.tracks.size(), on_road, found.size());
  for (const match::PooledDoubt& pooled : found) {
    std::cout << fmt::format("{:5.1f} % by {} of {}: {}\n", 100.0 * pooled.doubt.probability,
                             pooled.drives.size(), options.tracks.size(),
                             explanation(pooled.doubt, network));
  }
  if (!options.output.empty()) match::write_doubts(options.output, found, network);
  return 0;
}

}  // namespace

void add_map_doubts(CLI::App& map, Command& command) {
  auto options = std::make_shared<DoubtOptions>();
  CLI::App* sub = map.add_subcommand(
      "doubts",
      "Find what drives contradict of a map: missing roads, wrong directions, forbidden turns that "
      "were driven, and shifted roads, each with its probability");
  add_map_argument(*sub, *options);
  sub->add_option("TRACK", options->tracks, "Tracks or logs, as for `maploop match`")->required();
  sub->add_option("-o,--output", options->output,
                  "Write them to this GeoJSON file, which JOSM opens, and which `maploop map build "
                  "--doubts` takes")
      ->check(writable_file());
  sub->add_option("--min-probability", options->min_probability, "Leave out less likely ones")
      ->check(number_in(0.0, 1.0))
      ->capture_default_str();
  add_match_input_options(*sub, *options);
  sub->callback([options, &command] { command = [options] { return find_doubts(*options); }; });
}

}  // namespace maploop::tools
