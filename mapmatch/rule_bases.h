// The matcher's rule bases and the location of their files are defined here.
#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include "mapmatch/fuzzy_system.h"

namespace maploop::mapmatch {

// These are the inputs of each rule base in the order of evaluation (rules/*.fll explain them).
inline constexpr std::array<std::string_view, 4> initial_inputs{"speed", "heading_error",
                                                                "distance", "hdop"};
inline constexpr std::array<std::string_view, 7> along_inputs{
    "speed", "hdop", "alpha", "beta", "overshoot", "turn", "turn_rate"};
inline constexpr std::array<std::string_view, 9> visual_along_inputs{
    "speed", "hdop",      "alpha",        "beta",       "overshoot",
    "turn",  "turn_rate", "visual_speed", "visual_turn"};
inline constexpr std::array<std::string_view, 6> junction_inputs{
    "speed", "heading_error", "distance", "hdop", "connectivity", "distance_error"};

struct RuleBases {
  FuzzySystem initial;       // IMP: a link near the fix
  FuzzySystem along;         // SMP-1: still on the link, 13 rules
  FuzzySystem along_visual;  // the same and 7 rules for visual odometry
  FuzzySystem junction;      // SMP-2: a link after a junction
};

// Reads initial_matching.fll, along_link.fll, along_link_visual.fll and junction.fll from a folder.
// Throws FllError.
RuleBases read_rule_bases(const std::filesystem::path& folder);

// Returns the folder of the rules: MAPLOOP_RULES, or the folder rules of shared_folder().
std::filesystem::path default_rules();

}  // namespace maploop::mapmatch
