// The options of commands that match tracks to a map: those of the matcher, and how map and tracks
// are read.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <vector>

#include "mapmatch/road_network.h"
#include "tools/command/matcher_options.h"
#include "tools/match/track_file.h"

namespace maploop::tools {

struct MatchInputOptions : MatcherOptions {
  std::vector<double> origin, box;             // degrees
  std::optional<RoadSide> side_of_road;        // on which traffic keeps
  double sigma = match::TrackOptions{}.sigma;  // m

  // These throw std::runtime_error naming the file. If the map is tiled and no box is given, the
  // network contains the roads about the tracks.
  mapmatch::RoadNetwork network(const std::vector<std::filesystem::path>& tracks) const;
  match::Track track(const std::filesystem::path& file) const;
};

void add_map_argument(CLI::App& command, MatchInputOptions& options);
// The other ones.
void add_match_input_options(CLI::App& command, MatchInputOptions& options);

}  // namespace maploop::tools
