// Writes matched tracks to files, and explains why fixes are not on a road of the map.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mapmatch/matcher.h"
#include "tools/match/track_file.h"

namespace maploop::match {

struct MatchedTrack {
  Track fixes;
  std::vector<mapmatch::MatchResult> results;                  // one for each fix
  std::string name{};                                          // of its file
  double lane_sigma = mapmatch::MatchParameters{}.lane_sigma;  // m, as the parameter says
  double max_gap = mapmatch::MatchParameters{}.max_gap;        // s without a fix: matching restarts

  // Returns the seconds from the first fix to this one.
  double second(std::size_t fix) const { return to_seconds(fixes[fix].stamp - fixes[0].stamp); }
  // Returns the indices of the fixes that the matcher used; their stamps increase.
  std::vector<std::size_t> used() const;
};

// Writes
// t,lat,lon,phase,way_id,node_a,node_b,matched_lat,matched_lon,azimuth_deg,likelihood,p_link,lanes,
// lane,p_lane, one line for each fix; ids are empty if it is not on a road, and lanes, which are
// those of the direction of travel, from 1 on the left, if the map does not tell. All writers throw
// std::runtime_error naming the file.
void write_match_csv(const std::filesystem::path& file, const MatchedTrack& track,
                     const mapmatch::RoadNetwork& network);
// Writes the fixes as points with their links and reasons, and the matched positions as a line.
void write_match_geojson(const std::filesystem::path& file, const MatchedTrack& track,
                         const mapmatch::RoadNetwork& network);
// Writes the matched positions as a track.
void write_match_gpx(const std::filesystem::path& file, const MatchedTrack& track,
                     const mapmatch::RoadNetwork& network);
// Writes a page that needs no network connection: what became of the fixes, the streets in the
// order of the drive, doubts about the map, and, with one cursor, a map, plots over time, and the
// reasons of each decision.
void write_match_html(const std::filesystem::path& file, const MatchedTrack& track,
                      const mapmatch::RoadNetwork& network, const mapmatch::RuleBases& rules);

// Counts the fixes that the matcher refused and those outside of the map, by their reason.
std::map<std::string, std::size_t> unused_fixes(const MatchedTrack& track,
                                                const mapmatch::RoadNetwork& network);

// Returns the reason and the remedy if the track cannot be used with this map: no fix is on a road,
// or the matcher refused more than half of them. Returns nothing otherwise.
std::optional<std::string> why_unusable(const MatchedTrack& track,
                                        const mapmatch::RoadNetwork& network);

}  // namespace maploop::match
