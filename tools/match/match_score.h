// Counts how often the matched way is the one really driven.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mapmatch/match_history.h"
#include "mapmatch/matcher.h"
#include "msgs/map_doubt.h"
#include "msgs/map_match.h"
#include "tools/match/track_file.h"

namespace maploop::match {

// A link really driven.
struct Label {
  std::int64_t way_id = 0, node_a = 0, node_b = 0;  // an OSM segment, in driving direction
  bool certain = false;  // conf = 1: not near a junction, and no other road could be meant
  std::optional<mapmatch::DirectedLink> link{};  // of a network, if it was looked up
};
using Labels = std::map<std::size_t, Label>;  // by the row number of the track

// Reads a CSV file with the columns frame, way_id, node_a, node_b and conf, plain or .gz. Throws
// std::runtime_error naming file and line.
Labels read_labels(const std::filesystem::path& file);

// Finds the links of a network by their segments.
class SegmentLinks {
 public:
  explicit SegmentLinks(const mapmatch::RoadNetwork& network);

  // Returns the link that a segment is part of, in the direction from a to b, or nothing if the
  // network has no such segment.
  std::optional<mapmatch::DirectedLink> find(std::int64_t node_a, std::int64_t node_b) const;
  void look_up(Labels& labels) const;

 private:
  std::map<std::pair<std::int64_t, std::int64_t>, mapmatch::DirectedLink> links_;
};

// A fix and its matched segment.
struct MatchedFix {
  std::optional<std::int64_t> way_id;  // empty: not on a road, or unknown
  std::int64_t node_a = 0, node_b = 0;
  double p_link = 0.0;
  std::optional<mapmatch::DirectedLink> link{};  // if it is known
};
// `vertex` is the first stored one of the segment, and `p` P(link).
MatchedFix on_segment(const mapmatch::RoadNetwork& network, mapmatch::DirectedLink link,
                      std::uint32_t vertex, double p);
MatchedFix matched_fix(const mapmatch::MatchResult& result, const mapmatch::RoadNetwork& network);

// These members receive what match_track() finds beside the matches, if they are set.
struct MatchOutputs {
  std::vector<MapDoubt>* doubts = nullptr;  // what the drive contradicts of the map, likely or not
  mapmatch::MatchHistory* history = nullptr;
};

// Returns the match of each fix of a track, and appends to the outputs.
std::vector<MatchedFix> match_track(mapmatch::Matcher& matcher, const Track& track,
                                    const MatchOutputs& outputs = {});

// Returns the matches of the fixes, each judged by the fixes until `lag` after it.
std::vector<MatchedFix> match_later(const mapmatch::MatchHistory& history, Duration lag,
                                    const mapmatch::RoadNetwork& network);

struct Tally {
  std::size_t fixes = 0, matched = 0, right = 0;

  Tally& operator+=(const Tally& more);
  std::size_t wrong() const { return fixes - right; }
  double share() const {
    return fixes ? static_cast<double>(right) / static_cast<double>(fixes) : 0;
  }
  double coverage() const {
    return fixes ? static_cast<double>(matched) / static_cast<double>(fixes) : 0;
  }
};

// For matches with P between k/10 and (k+1)/10: how many are right. They are compared by link if
// the matched and the driven link are known, otherwise by way.
struct Reliability {
  std::array<std::size_t, 10> fixes{}, right{};
  std::array<double, 10> p_sum{};

  Reliability& operator+=(const Reliability& more);
  // Returns the expected calibration error: the mean, over the fixes, of the difference between the
  // mean P of their bin and the share of it that is right.
  double calibration_error() const;
};

struct MatchScore {
  Tally all, certain;
  Reliability reliability;
  // On links that the network lacks, of labels that were looked up in it.
  std::size_t lacking_fixes = 0;
  double lacking_p_sum = 0.0;

  MatchScore& operator+=(const MatchScore& more);

  // `rows` are the track's row numbers of the fixes; fixes without a label do not count.
  void add(const std::vector<MatchedFix>& matched, const std::vector<std::size_t>& rows,
           const Labels& labels);
};

struct TimedMatch {
  Time stamp{};
  MatchedFix matched;
};
TimedMatch timed_match(const MapMatch& match);

// Reads the CSV file of `maploop match --csv` (files of other matchers need the columns t and
// way_id, and may have p_link, node_a, node_b) or the MAP_MATCH messages of an LCM log; plain or
// .gz. Returns them in the order of the file. Throws std::runtime_error naming file and line.
std::vector<TimedMatch> read_matches(const std::filesystem::path& file);
std::vector<TimedMatch> read_log_matches(const std::filesystem::path& file);

// Returns the index of the frame nearest to a time, or nothing if there is none within 60 ms.
// `stamps` increase.
std::optional<std::size_t> frame_at(Time t, const std::vector<Time>& stamps);

// Scores each match against the label of the frame nearest to it; matches without such a frame do
// not count.
MatchScore score_matches(const std::vector<TimedMatch>& matches, const std::vector<Time>& stamps,
                         const Labels& labels);

// Return the share of fixes on the right way and the coverage, of all labels and of certain ones;
// and a table of the mean P(link) and the share that was right, of ways or links as `what` says;
// and both as JSON.
std::string to_text(const MatchScore& score);
std::string to_text(const Reliability& reliability, std::string_view what = "way");
nlohmann::json to_json(const MatchScore& score);

}  // namespace maploop::match
