// This file describes where on the road map the vehicle is.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "msgs/local_frame.h"
#include "msgs/named_enum.h"
#include "msgs/sample.h"

namespace maploop {

// States which step of the matching a fix is in (IMP: initial, SMP: subsequent matching).
enum class MatchPhase : std::uint8_t {
  initial,      // IMP: no link is established yet
  along_link,   // SMP-1: still on the link
  at_junction,  // SMP-2: on another link since this fix, or still undecided
  off_road,     // on no road of the map
};

constexpr auto names_of(MatchPhase) {
  return names_up_to<MatchPhase::off_road>({"initial", "along link", "at junction", "off road"});
}

// States why a fix was not used.
enum class FixRefusal : std::uint8_t {
  none,
  not_later,
  not_finite,
  bad_covariance,
  no_position,
  out_of_reach
};

constexpr auto names_of(FixRefusal) {
  return names_up_to<FixRefusal::out_of_reach>(
      {"none", "not later than the fix before", "a value is not finite",
       "the covariance is not positive", "there is no position yet",
       "farther from the fix before than a vehicle can drive"});
}

// Names the rule base by which a candidate was judged.
enum class RuleBase : std::uint8_t { initial, along, along_visual, junction };

constexpr auto names_of(RuleBase) {
  return names_up_to<RuleBase::junction>({"initial", "along", "along, visual", "junction"});
}

// This is a link with its direction of travel: from its first vertex to its last (forward), or the
// reverse.
struct DirectedLink {
  std::uint32_t link = 0;  // index in the road network in use
  bool forward = true;     // whether it is driven from its first vertex to its last

  // Returns the same link, driven the other way.
  DirectedLink reversed() const { return {link, !forward}; }
  bool operator==(const DirectedLink&) const = default;  // same link and same direction

  void archive(auto& ar) { ar(link, forward); }
};

// This is a link that the vehicle may be on. NaN means unknown.
struct MatchCandidate {
  static constexpr std::size_t max_rules = 32;  // of a rule base
  // The value of a member that is not known.
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  DirectedLink link;                // as it would be driven
  std::int64_t way_id = 0;          // OpenStreetMap's, of the segment, ...
  std::int64_t node_a = 0;          // ... which is driven from here
  std::int64_t node_b = 0;          // to here
  double along = 0.0;               // m from where the link is entered
  double distance = 0.0;            // m from the fix
  double azimuth_error = unknown;   // rad, 0 to pi
  double connectivity = 0.0;        // 1 or 0.9: legal from the previous link; 0.3: not; 0: no path
  double distance_error = unknown;  // m between the path along the roads and the distance travelled
  RuleBase rules = RuleBase::initial;      // by which it was judged
  bool decided = false;                    // whether any rule applied
  double likelihood = 0.0;                 // of the rules, 10 to 100
  std::array<float, max_rules> weights{};  // of each rule
  double probability = 0.0;                // P(link)

  void archive(auto& ar) {
    ar(link, way_id, node_a, node_b, along, distance, azimuth_error, connectivity, distance_error,
       rules, decided, likelihood, weights, probability);
  }
};

// This is the lane that the vehicle is in, given that it is on the matched road.
struct LanePosition {
  std::int32_t lanes = 0;    // in the direction of travel; 0: the map does not tell
  std::int32_t lane = 0;     // the likeliest one, from 1 on the left to `lanes`; 0: unknown
  double probability = 0.0;  // P(lane)
  double offset = 0.0;       // m, of the vehicle from its middle, positive to the right

  void archive(auto& ar) { ar(lanes, lane, probability, offset); }
};

// This is what the matcher decides about one fix.
struct LinkMatch {
  static constexpr std::size_t max_candidates = 24;  // further links are left out

  FixRefusal refusal = FixRefusal::none;   // of this fix; the rest is then the previous fix's
  MatchPhase phase = MatchPhase::initial;  // of the matching, after this fix
  bool on_road = false;  // whether there is a link; the members up to `margin` describe it
  DirectedLink link;     // the matched one, as driven
  double along = 0.0;    // m from where the link is entered
  double sigma_along = 0.0, sigma_across = 0.0;  // m, of the matched position
  double likelihood = 0.0;                       // of the rules, 10 to 100
  double probability = 0.0;                      // P(link), calibrated
  double margin = 0.0;                           // to the probability of the second
  double off_road = 0.0;                         // P(the vehicle is on no road of the map)
  std::array<MatchCandidate, max_candidates> candidates{};  // the most likely first
  std::size_t candidate_count = 0;  // valid ones at the front of `candidates`

  void archive(auto& ar) {
    ar(refusal, phase, on_road, link, along, sigma_along, sigma_across, likelihood, probability,
       margin, off_road, candidates, candidate_count);
  }
};

// This is the match of the fused state at `stamp`. Members in `enu` are in the frame of that state;
// azimuths are clockwise from its north. It is sent for every tick; `refusal` and `on_road` tell
// whether it contains a link. If the state is refused there are neither link nor candidates.
struct MapMatch : Sample, LinkMatch {
  std::int64_t way_id = 0, node_a = 0, node_b = 0;           // OSM segment, as driven
  Geodetic origin;                                           // of enu
  Eigen::Vector2d vehicle_enu = Eigen::Vector2d::Zero();     // m, the state that was matched
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  // m^2, of vehicle_enu
  double vehicle_azimuth = 0.0;                              // rad
  double speed = 0.0;                                        // m/s, forward
  Eigen::Vector2d matched_enu = Eigen::Vector2d::Zero();     // m, on the link's line
  double link_azimuth = 0.0;  // rad, of the link at the matched point, as driven
  double cross_track = 0.0;   // m, of the vehicle from the line, positive to its right
  double half_width = 0.0;    // m, of the carriageway
  LanePosition lane;          // given that the link is right
  double bend = 0.0;          // rad, change of the road's azimuth from 15 m behind to 15 m ahead
  double to_junction = 0.0;   // m ahead along the link; the junction behind is `along` metres away

  void archive(auto& ar) {
    ar(static_cast<Sample&>(*this), static_cast<LinkMatch&>(*this), way_id, node_a, node_b, origin,
       vehicle_enu, covariance, vehicle_azimuth, speed, matched_enu, link_azimuth, cross_track,
       half_width, lane, bend, to_junction);
  }
};

// This describes the same match in words for people.
struct MapMatchWords {
  // One candidate of the match.
  struct Candidate {
    std::string road;                     // name and way
    std::vector<std::string> objections;  // arguments against it
    std::vector<std::string> rules;       // those that applied, the weightiest first, with weights
  };
  std::string explanation;            // the link and why it, or why there is none
  std::vector<Candidate> candidates;  // in the order of the match
};

}  // namespace maploop
