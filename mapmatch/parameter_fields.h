// Every parameter by name: what a configuration file sets, and what an archive must agree with.
#pragma once

#include <concepts>
#include <type_traits>

#include "mapmatch/feedback_parameters.h"
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
  f("doubt_slope", p.doubt_slope);
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

template <class Parameters, class F>
requires std::same_as<std::remove_const_t<Parameters>, FeedbackParameters>
void fields(Parameters& p, F&& f) {
  f("min_speed", p.min_speed);
  f("max_azimuth_error", p.max_azimuth_error);
  f("azimuth_sigmas", p.azimuth_sigmas);
  f("max_lost_azimuth", p.max_lost_azimuth);
  f("max_turn", p.max_turn);
  f("turn_interval", p.turn_interval);
  f("lost_turn_interval", p.lost_turn_interval);
  f("junction_distance", p.junction_distance);
  f("junction_sigmas", p.junction_sigmas);
  f("min_probability", p.min_probability);
  f("min_margin", p.min_margin);
  f("parallel_azimuth", p.parallel_azimuth);
  f("parallel_sigmas", p.parallel_sigmas);
  f("window", p.window);
  f("max_mean_nis", p.max_mean_nis);
  f("spacing", p.spacing);
  f("azimuth_spacing", p.azimuth_spacing);
  f("cross_sigma", p.cross_sigma);
  f("map_sigma", p.map_sigma);
  f("lane_share", p.lane_share);
  f("azimuth_sigma", p.azimuth_sigma);
  f("bend_sigma", p.bend_sigma);
  f("straight", p.straight);
  f("chord", p.chord);
  f("ramp", p.ramp);
  f("ramp_factor", p.ramp_factor);
  f("new_road_turn", p.new_road_turn);
}

}  // namespace maploop::mapmatch
