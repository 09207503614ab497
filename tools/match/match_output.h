// Matched tracks as files.
#pragma once

#include <filesystem>
#include <vector>

#include "mapmatch/matcher.h"
#include "tools/match/track.h"

namespace maploop::match {

struct MatchedTrack {
  Track fixes;
  std::vector<mapmatch::MatchResult> results;  // one a fix
};

// t,lat,lon,phase,way_id,node_a,node_b,matched_lat,matched_lon,azimuth_deg,likelihood,p_link: one
// line a fix, ids empty where it is on no road. Throw std::runtime_error naming the file.
void write_match_csv(const std::filesystem::path& file, const MatchedTrack& track,
                     const mapmatch::RoadNetwork& network);
// Points of the fixes with their links and reasons, and the line of the matched positions.
void write_match_geojson(const std::filesystem::path& file, const MatchedTrack& track,
                         const mapmatch::RoadNetwork& network);
// The matched positions as a track.
void write_match_gpx(const std::filesystem::path& file, const MatchedTrack& track,
                     const mapmatch::RoadNetwork& network);
// A page with the network about the track, the fixes and their links; a click on a fix shows its
// candidates, their rules and reasons. Needs no network connection.
void write_match_html(const std::filesystem::path& file, const MatchedTrack& track,
                      const mapmatch::RoadNetwork& network, const mapmatch::RuleBases& rules);

}  // namespace maploop::match
