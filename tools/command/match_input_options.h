// The options of commands that match tracks to a map: the map, how tracks are read, the rules and
// the parameters.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "mapmatch/match_parameters.h"
#include "mapmatch/road_network.h"
#include "mapmatch/rule_bases.h"
#include "tools/match/track_file.h"

namespace maploop::tools {

struct MatchInputOptions {
  std::filesystem::path map, rules = mapmatch::default_rules();
  std::vector<double> origin, box;  // degrees
  std::vector<std::string> set;
  double sigma = match::TrackOptions{}.sigma;  // m

  // These throw std::runtime_error naming the file or the setting.
  mapmatch::RoadNetwork network() const;
  mapmatch::RuleBases rule_bases() const;
  mapmatch::MatchParameters parameters() const;
  match::Track track(const std::filesystem::path& file) const;
};

void add_map_argument(CLI::App& command, MatchInputOptions& options);
// The other ones.
void add_match_input_options(CLI::App& command, MatchInputOptions& options);

}  // namespace maploop::tools
