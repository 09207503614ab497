#include "mapmatch/validate.h"

#include <array>
#include <concepts>
#include <numbers>

#include "mapmatch/parameter_fields.h"
#include "msgs/parameter_range.h"

namespace maploop::mapmatch {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double long_time = 1e6;   // s
constexpr double any_weight = 1e9;  // of evidence: more changes nothing

// A least above 0 is of what is divided by, or without which nothing is remembered.
constexpr std::array match_ranges{ParameterRange{"map_sigma", 0.01, 1000.0, "m"},
                                  ParameterRange{"road_noise", 0.01, 1000.0, "m"},
                                  ParameterRange{"link_memory", 0.0, 1.0},
                                  ParameterRange{"azimuth_noise", 0.001, pi, "rad"},
                                  ParameterRange{"wrong_way", 0.0, any_weight},
                                  ParameterRange{"banned_turn", 0.0, any_weight},
                                  ParameterRange{"minor_road", 0.0, any_weight},
                                  ParameterRange{"turn_round", 0.0, any_weight},
                                  ParameterRange{"correlation_time", 0.01, long_time, "s"},
                                  ParameterRange{"distance_scale", 0.0, 1.0},
                                  ParameterRange{"corner", 0.0, 1000.0, "m"},
                                  ParameterRange{"gate", 0.01, any_weight},
                                  ParameterRange{"lookahead", 0.0, 10000.0, "m"},
                                  ParameterRange{"birth", 0.0, any_weight},
                                  ParameterRange{"prune", 0.01, any_weight},
                                  ParameterRange{"memory", 0.01, long_time, "s"},
                                  ParameterRange{"position_weight", 0.0, 1000.0},
                                  ParameterRange{"azimuth_weight", 0.0, 1000.0},
                                  ParameterRange{"misfit", 0.0, any_weight},
                                  ParameterRange{"wrong_way_misfit", 0.0, any_weight},
                                  ParameterRange{"misfit_rate", 0.0, 1000.0},
                                  ParameterRange{"trust", 0.0, 1000.0},
                                  ParameterRange{"trust_slope", 0.0, 1000.0},
                                  ParameterRange{"doubt_slope", 0.0, 1000.0},
                                  ParameterRange{"off_road_rate", 0.0, 1000.0},
                                  ParameterRange{"fuzzy_weight", 0.0, 1000.0},
                                  ParameterRange{"stay", 0.0, 100.0},
                                  ParameterRange{"accept", 0.0, 100.0},
                                  ParameterRange{"sure", 0.0, 1.0},
                                  ParameterRange{"settle_within", 0.0, 10000.0, "m"},
                                  ParameterRange{"agreement", 0.0, long_time, "s"},
                                  ParameterRange{"min_speed", 0.0, 100.0, "m/s"},
                                  ParameterRange{"distance_unit", 0.01, 1000.0, "m"},
                                  ParameterRange{"hdop_unit", 0.01, 1000.0, "m"},
                                  ParameterRange{"visual_gate", 0.0, pi, "rad"},
                                  ParameterRange{"max_gap", 0.01, long_time, "s"}};

}  // namespace

void validate(const MatchParameters& parameters) {
  fields(parameters, []<class T>(std::string_view name, const T& value) {
    if constexpr (!std::same_as<T, bool>) check_range("mapmatch", match_ranges, name, value);
  });
}

}  // namespace maploop::mapmatch
