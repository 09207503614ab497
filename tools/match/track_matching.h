// Matches whole tracks to a map, one or many, and writes what was asked for of each.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tools/match/match_output.h"

namespace maploop::match {

// How the tracks are matched. What it refers to must outlive it.
struct TrackMatching {
  const mapmatch::RoadNetwork& network;
  const mapmatch::RuleBases& rules;
  const mapmatch::MatchParameters& parameters;
  Duration lag{};  // each fix is judged by the fixes of so long after it, too

  // Appends the time of each fix to `microseconds` if it is given.
  MatchedTrack match(Track fixes, std::string name, std::vector<double>* microseconds) const;
};

// Writes a matched track to a file.
using TrackWriter = std::function<void(const std::filesystem::path& file, const MatchedTrack&)>;

struct TrackOutput {
  std::filesystem::path folder;
  std::string ending;  // of a file's name: ".csv"
  TrackWriter write;
};

// Matches many tracks by several threads. Each output has a file in its folder, named after the
// track. Writes a line for each track and one for all to standard output, progress to standard
// error, and there what is wrong with a track, which does not stop the others. Throws
// std::runtime_error before the work if two tracks have the same name, and at its end if one could
// not be matched.
void match_tracks(std::span<const std::filesystem::path> files,
                  const std::function<Track(const std::filesystem::path&)>& read,
                  const TrackMatching& matching, std::span<const TrackOutput> outputs);

}  // namespace maploop::match
