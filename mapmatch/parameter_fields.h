// Every parameter by name: what a configuration file sets, and what an archive must agree with.
#pragma once

#include <concepts>
#include <type_traits>

#include "mapmatch/match_parameters.h"

namespace maploop::mapmatch {

// Calls f(name, member) for each; Parameters is MatchParameters, const or not.
template <class Parameters, class F>
requires std::same_as<std::remove_const_t<Parameters>, MatchParameters>
void fields(Parameters& p, F&& f) {
  f("map_sigma", p.map_sigma);
  f("road_noise", p.road_noise);
  f("link_memory", p.link_memory);
  f("azimuth_noise", p.azimuth_noise);
  f("wrong_way", p.wrong_way);
  f("banned_turn", p.banned_turn);
  f("minor_road", p.minor_road);
  f("turn_round", p.turn_round);
  f("correlation_time", p.correlation_time);
  f("distance_scale", p.distance_scale);
  f("corner", p.corner);
  f("gate", p.gate);
  f("lookahead", p.lookahead);
  f("birth", p.birth);
  f("prune", p.prune);
  f("memory", p.memory);
  f("position_weight", p.position_weight);
  f("azimuth_weight", p.azimuth_weight);
  f("misfit", p.misfit);
  f("wrong_way_misfit", p.wrong_way_misfit);
  f("misfit_rate", p.misfit_rate);
  f("trust", p.trust);
  f("trust_slope", p.trust_slope);
  f("off_road_rate", p.off_road_rate);
  f("fuzzy_weight", p.fuzzy_weight);
  f("stay", p.stay);
  f("accept", p.accept);
  f("sure", p.sure);
  f("settle_within", p.settle_within);
  f("agreement", p.agreement);
  f("min_speed", p.min_speed);
  f("distance_unit", p.distance_unit);
  f("hdop_unit", p.hdop_unit);
  f("visual_gate", p.visual_gate);
  f("paths", p.paths);
  f("max_gap", p.max_gap);
}

}  // namespace maploop::mapmatch
