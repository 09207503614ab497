// What the matcher says of a fix.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>

#include "mapmatch/fuzzy_system.h"
#include "mapmatch/road_network.h"
#include "mapmatch/vehicle_fix.h"

namespace maploop::mapmatch {

enum class MatchPhase : std::uint8_t {
  initial,      // IMP: no link is established yet
  along_link,   // SMP-1: still on the link
  at_junction,  // SMP-2: on another link since this fix
  off_road,     // on no road of the map
};

constexpr std::string_view to_string(MatchPhase phase) {
  switch (phase) {
    case MatchPhase::initial:
      return "initial";
    case MatchPhase::along_link:
      return "along link";
    case MatchPhase::at_junction:
      return "at junction";
    case MatchPhase::off_road:
      return "off road";
  }
  return "unknown";
}

// Why a fix was not used.
enum class FixRefusal : std::uint8_t { none, not_later, not_finite, bad_covariance };

constexpr std::string_view to_string(FixRefusal refusal) {
  switch (refusal) {
    case FixRefusal::none:
      return "none";
    case FixRefusal::not_later:
      return "not later than the fix before";
    case FixRefusal::not_finite:
      return "a value is not finite";
    case FixRefusal::bad_covariance:
      return "the covariance is not positive";
  }
  return "unknown";
}

// The rule base that a candidate was judged by.
enum class RuleBase : std::uint8_t { initial, along, along_visual, junction };

struct MatchCandidate {
  DirectedLink link;
  double along = 0.0;               // m from where the link is entered
  double distance = 0.0;            // m from the fix
  double azimuth_error = unknown;   // rad, 0 to pi
  double connectivity = 0.0;        // 1: legal from the link before; 0: not
  double distance_error = unknown;  // m between the way along the roads and the distance travelled
  RuleBase rules = RuleBase::initial;
  bool decided = false;                                 // whether any rule applied
  double likelihood = 0.0;                              // of the rules, 10 to 100
  std::array<float, FuzzySystem::max_rules> weights{};  // of each rule
  double probability = 0.0;                             // P(link)
};

struct MatchResult {
  static constexpr std::size_t max_candidates = 24;

  Time stamp{};
  FixRefusal refusal = FixRefusal::none;
  MatchPhase phase = MatchPhase::initial;
  bool on_road = false;  // whether there is a link at all; the rest to `margin` is about it
  DirectedLink link;
  LinkPoint point;                               // matched position and direction
  double along = 0.0;                            // m from where the link is entered
  double sigma_along = 0.0, sigma_across = 0.0;  // m, of the matched position
  double likelihood = 0.0;                       // of the rules, 10 to 100
  double probability = 0.0;                      // P(link), calibrated
  double margin = 0.0;                           // to that of the second
  double off_road = 0.0;                         // P that the vehicle is on no road of the map
  std::array<MatchCandidate, max_candidates> candidates{};  // the most likely first
  std::size_t candidate_count = 0;
};

}  // namespace maploop::mapmatch
