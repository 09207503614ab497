// maploop map doubts: what drives contradict of a map.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapmatch/doubt_collector.h"
#include "mapmatch/reasons.h"
#include "tools/command/commands.h"
#include "tools/command/match_input_options.h"
#include "tools/command/option_checks.h"
#include "tools/command/progress.h"
#include "tools/match/doubts_file.h"
#include "tools/match/track_matching.h"

namespace maploop::tools {
namespace {

struct DoubtOptions : MatchInputOptions {
  std::filesystem::path output;
  std::vector<std::filesystem::path> tracks;
  double min_probability = 0.5;
};

void add_doubts(const match::MatchedTrack& track, const match::TrackMatching& matching,
                match::DoubtPool& pool) {
  mapmatch::MatchParameters parameters = matching.parameters;
  parameters.max_gap = track.max_gap;
  mapmatch::DoubtCollector collector(matching.network, parameters);
  const auto take = [&](std::span<const MapDoubt> some) {
    for (const MapDoubt& doubt : some) pool.add(doubt, track.name);
  };
  for (std::size_t i = 0; i < track.fixes.size(); ++i) {
    take(collector.add(track.results[i], track.fixes[i]));
  }
  take(collector.finish());
}

// A track that cannot be used is said, and does not stop the others.
int find_doubts(const DoubtOptions& options) {
  const mapmatch::RoadNetwork network = options.network(options.tracks);
  const mapmatch::RuleBases rules = options.rule_bases();
  const mapmatch::MatchParameters parameters = options.parameters();
  if (!parameters.paths) {
    throw std::runtime_error(
        "paths = false leaves the rules alone, which give no probabilities of a link: doubts need "
        "the paths");
  }
  const match::TrackMatching matching{network, rules, parameters};
  match::DoubtPool pool(network);
  std::size_t fixes = 0, on_road = 0, done = 0;
  std::vector<std::string> unusable;
  Progress progress("tracks");
  for (const std::filesystem::path& file : options.tracks) {
    try {
      const auto track = matching.match(options.track(file), file.string(), nullptr);
      if (const auto why = match::why_unusable(track, network))
        throw std::runtime_error(file.string() + ": " + *why);
      add_doubts(track, matching, pool);
      fixes += track.fixes.size();
      for (const std::size_t i : track.used()) on_road += track.results[i].on_road ? 1 : 0;
    } catch (const std::exception& e) {
      unusable.emplace_back(e.what());
    }
    progress.at(static_cast<double>(++done), static_cast<double>(options.tracks.size()));
  }
  for (const std::string& why : unusable) std::cerr << "maploop: " << why << '\n';
  const std::size_t used = options.tracks.size() - unusable.size();
  if (used == 0) throw std::runtime_error("none of the tracks can be used");
  const auto found = pool.likelier_than(options.min_probability);
  std::cout << fmt::format("{} fixes of {} tracks, {} on a road; {} doubts\n", fixes, used, on_road,
                           found.size());
  for (const match::PooledDoubt& pooled : found) {
    std::cout << fmt::format("{:5.1f} % by {} of {}: {}\n", 100.0 * pooled.doubt.probability,
                             pooled.drives.size(), used, explanation(pooled.doubt, network));
  }
  if (!options.output.empty()) match::write_doubts(options.output, found, network);
  if (!unusable.empty()) {
    throw std::runtime_error(
        fmt::format("{} of {} tracks could not be used", unusable.size(), options.tracks.size()));
  }
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
