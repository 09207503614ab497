#include "mapmatch/parameter_table.h"

#include <numbers>

namespace maploop::mapmatch {

ParameterTable<MatchParameters> parameter_table(const MatchParameters&) {
  using enum Audience;
  using P = MatchParameters;
  constexpr double pi = std::numbers::pi;
  constexpr double long_time = 1e6;   // s
  constexpr double any_weight = 1e9;  // a larger one changes nothing
  // A least value above 0 belongs to what is divided by, or without which nothing is remembered.
  constexpr DataChoice trust_choice{
      "KITTI 01, 06 and 10", "what is said where the map lacks the road",
      "matching on 01, 06, 10, and their part of the reliability diagram"};
  constexpr DataChoice hop_trust_choice{"KITTI 00, 02, 03 and 04",
                                        "time sure of a wrong link where a driven way is missing",
                                        "wrong maps of these drives"};
  constexpr DataChoice trust_slope_choice{"KITTI 01, 06 and 10", "as `trust`", "as `trust`"};
  constexpr DataChoice doubt_slope_choice{"KITTI odometry sequences, all eight",
                                          "the reliability diagram", "the reliability diagram"};
  constexpr DataChoice lane_sigma_choice{"KITTI odometry sequences, 34 two-way roads",
                                         "distance from the roads' lines about its mean",
                                         "P(lane)"};
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"map_sigma", &P::map_sigma, 0.01, 1000.0, "m", usual,
       "Standard deviation per axis of the map: centre lines, lanes and datum. It is constant over "
       "some 100 m."},
      {"road_noise", &P::road_noise, 0.01, 1000.0, "m", expert,
       "Standard deviation per axis of the part of the map's error that changes from second to "
       "second."},
      {"link_memory", &P::link_memory, 0.0, 1.0, "1", expert,
       "Share of the map's error that persists behind a junction."},
      {"azimuth_noise", &P::azimuth_noise, 0.001, pi, "rad", expert,
       "Standard deviation of the azimuth: of the links, and of the vehicle's own path around "
       "bends."},
      {"wrong_way", &P::wrong_way, 0.0, any_weight, "nat", expert,
       "Cost (-ln P) of driving against a one-way street."},
      {"doubted_way", &P::doubted_way, 0.0, any_weight, "nat", expert,
       "Cost (-ln P) of each direction of a one-way street whose direction the map itself "
       "contradicts (ln 2)."},
      {"banned_turn", &P::banned_turn, 0.0, any_weight, "nat", expert,
       "Cost (-ln P) of a banned turn."},
      {"minor_road", &P::minor_road, 0.0, any_weight, "nat", expert,
       "Cost (-ln P) of a service way, a track or a road that is not public."},
      {"turn_round", &P::turn_round, 0.0, any_weight, "nat", expert, "Cost (-ln P) of a U-turn."},
      {"lane_sigma", &P::lane_sigma, 0.01, 1000.0, "m", expert,
       "Standard deviation of the vehicle's distance from the middle of its lane, with the error "
       "of "
       "the road's line.",
       lane_sigma_choice},

      {"correlation_time", &P::correlation_time, 0.01, long_time, "s", expert,
       "Correlation time of the errors of the fixes."},
      {"distance_scale", &P::distance_scale, 0.0, 1.0, "1", expert,
       "Standard deviation of the scale of the travelled distance."},
      {"corner", &P::corner, 0.0, 1000.0, "m/sqrt(rad)", expert,
       "Length by which a vehicle cuts a corner, for a turn of 1 rad."},
      {"gate", &P::gate, 0.01, any_weight, "1", expert,
       "Squared normalized innovation that a fix may have at most."},

      {"lookahead", &P::lookahead, 0.0, 10000.0, "m", expert,
       "Distance before a junction at which its exits become hypotheses."},
      {"birth", &P::birth, 0.0, any_weight, "nat/s", expert,
       "Cost (-ln P) of the vehicle being where no hypothesis is."},
      {"prune", &P::prune, 0.01, any_weight, "nat", expert,
       "A hypothesis whose -ln P exceeds that of the best one by more is removed."},
      {"memory", &P::memory, 0.01, long_time, "s", expert,
       "Time in which evidence loses 1 - 1/e of its weight."},
      {"position_weight", &P::position_weight, 0.0, 1000.0, "1", expert,
       "Weight of positions as evidence."},
      {"azimuth_weight", &P::azimuth_weight, 0.0, 1000.0, "1/s", expert,
       "Weight of azimuths as evidence."},

      {"misfit", &P::misfit, 0.0, any_weight, "1", expert,
       "Squared normalized offset and azimuth beyond which a link no longer fits."},
      {"wrong_way_misfit", &P::wrong_way_misfit, 0.0, any_weight, "1", expert,
       "Misfit that is added for driving against a one-way street."},
      {"misfit_rate", &P::misfit_rate, 0.0, 1000.0, "1/s", expert,
       "Weight of offsets as evidence between links."},
      {"trust", &P::trust, 0.0, 1000.0, "nat", expert, "Log odds of a link that fits perfectly.",
       trust_choice},
      {"hop_trust", &P::hop_trust, -1000.0, 1000.0, "nat", expert,
       "The same of a link that was not reached along the roads of the map.", hop_trust_choice},
      {"trust_distance", &P::trust_distance, 0.01, 100000.0, "m", expert,
       "Distance over which a link that fits regains `trust`."},
      {"trust_slope", &P::trust_slope, 0.0, 1000.0, "nat", expert,
       "Log odds that a unit of misfit takes away (from the reliability diagram).",
       trust_slope_choice},
      {"doubt_slope", &P::doubt_slope, 0.0, 1000.0, "1", expert,
       "Slope of the log odds below those of 0.9, which do not fall faster.", doubt_slope_choice},
      {"off_road_rate", &P::off_road_rate, 0.0, 1000.0, "1/m", expert,
       "Evidence per unit of misfit and metre driven that the vehicle is off the road."},

      {"fuzzy_weight", &P::fuzzy_weight, 0.0, 1000.0, "1", expert,
       "Weight of ln(L/100) of the fuzzy rules beside ln P of the paths."},
      {"stay", &P::stay, 0.0, 100.0, "1", expert,
       "Likelihood L2 from which the vehicle is still on its link."},
      {"accept", &P::accept, 0.0, 100.0, "1", expert,
       "Likelihood L3 that a link behind a junction needs. Below it matching starts again."},
      {"sure", &P::sure, 0.0, 1.0, "1", expert,
       "Margin of probability from which the link behind a junction is settled."},
      {"settle_within", &P::settle_within, 0.0, 10000.0, "m", expert,
       "Distance behind a junction at which the link is settled in any case."},
      {"agreement", &P::agreement, 0.0, long_time, "s", expert,
       "Time for which one link must be the best before it is accepted."},
      {"min_speed", &P::min_speed, 0.0, 100.0, "m/s", expert,
       "Speed from which azimuths are used."},
      {"distance_unit", &P::distance_unit, 0.01, 1000.0, "m", expert,
       "Standard deviation of the fixes that the distances of the rules were made for."},
      {"hdop_unit", &P::hdop_unit, 0.01, 1000.0, "m", expert,
       "Horizontal standard deviation that stands for an HDOP of 1."},
      {"visual_gate", &P::visual_gate, 0.0, pi, "rad", expert,
       "Largest difference from the rotation of visual odometry in a second. 0: not used."},
      {"paths", &P::paths, expert, "Whether path hypotheses are used beside the fuzzy rules."},
      {"max_gap", &P::max_gap, 0.01, long_time, "s", expert,
       "Time without a fix after which matching starts again."},
  });
  return {"mapmatch", "Map matching.", table};
}

}  // namespace maploop::mapmatch
