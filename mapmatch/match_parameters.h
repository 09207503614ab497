// Parameters of map matching; parameter_table.cpp describes each.
#pragma once

namespace maploop::mapmatch {

// Holds the parameters of the matcher, of its path hypotheses and of its fuzzy rules.
struct MatchParameters {
  // --- The map
  double map_sigma = 3.5;       // m
  double road_noise = 2.0;      // m
  double link_memory = 0.1;     // share of the map's error that persists behind a junction
  double azimuth_noise = 0.14;  // rad
  double wrong_way = 5.0;       // -ln P of driving against a one-way street
  double doubted_way = 0.7;  // -ln P of each direction of a one-way street that the map contradicts
  double banned_turn = 3.0;  // -ln P of a banned turn
  double minor_road = 1.0;   // -ln P of a service way, a track or a road that is not public
  double turn_round = 4.0;   // -ln P of a U-turn
  double lane_sigma = 1.1;   // m

  // --- The fixes' errors
  double correlation_time = 30.0;  // s
  double distance_scale = 0.03;    // sigma of the scale of the travelled distance
  double corner = 2.0;             // m/sqrt(rad)
  double gate = 25.0;              // largest squared normalized innovation of a fix

  // --- Path hypotheses
  double lookahead = 15.0;       // m
  double birth = 7.0;            // -ln P/s
  double prune = 14.0;           // -ln P behind the best hypothesis at which one is removed
  double memory = 60.0;          // s
  double position_weight = 1.0;  // of positions as evidence
  double azimuth_weight = 0.7;   // 1/s

  // --- Off the road
  double misfit = 12.0;           // squared normalized offset and azimuth of a link that just fits
  double wrong_way_misfit = 6.0;  // is added for driving against a one-way street
  double misfit_rate = 0.5;       // 1/s
  double trust = 5.0;             // log odds
  double hop_trust = 0.0;         // log odds
  double trust_distance = 150.0;  // m
  double trust_slope = 0.8;       // log odds
  double doubt_slope = 0.15;      // of log odds below those of 0.9
  double off_road_rate = 0.1;     // 1/m

  // --- Fuzzy process
  double fuzzy_weight = 0.3;    // of ln(L/100) of the rules beside ln P of the paths
  double stay = 60.0;           // likelihood L2, 0 to 100, from which the link is kept
  double accept = 60.0;         // likelihood L3, 0 to 100, that a link behind a junction needs
  double sure = 0.5;            // margin of probability that settles the link behind a junction
  double settle_within = 60.0;  // m
  double agreement = 3.0;       // s
  double min_speed = 1.0;       // m/s
  double distance_unit = 8.0;   // m
  double hdop_unit = 4.0;       // m
  double visual_gate = 0.052;   // rad
  bool paths = true;            // whether path hypotheses are used beside the rules
  double max_gap = 10.0;        // s
};

}  // namespace maploop::mapmatch
