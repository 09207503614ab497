// Parameters of map matching; parameter_table.cpp describes each.
#pragma once

namespace maploop::mapmatch {

struct MatchParameters {
  // --- The map
  double map_sigma = 3.5;   // m
  double road_noise = 2.0;  // m
  double link_memory = 0.1;
  double azimuth_noise = 0.14;  // rad
  double wrong_way = 5.0;
  double banned_turn = 3.0;
  double minor_road = 1.0;
  double turn_round = 4.0;

  // --- The fixes' errors
  double correlation_time = 30.0;  // s
  double distance_scale = 0.03;
  double corner = 2.0;  // m/sqrt(rad)
  double gate = 25.0;

  // --- Path hypotheses
  double lookahead = 15.0;  // m
  double birth = 7.0;       // -ln P/s
  double prune = 14.0;
  double memory = 60.0;  // s
  double position_weight = 1.0;
  double azimuth_weight = 0.7;  // 1/s

  // --- Off the road
  double misfit = 12.0;
  double wrong_way_misfit = 6.0;
  double misfit_rate = 0.5;       // 1/s
  double trust = 5.0;             // log odds
  double hop_trust = 0.0;         // log odds
  double trust_distance = 150.0;  // m
  double trust_slope = 0.8;       // log odds
  double doubt_slope = 0.15;
  double off_road_rate = 0.1;  // 1/m

  // --- Fuzzy process
  double fuzzy_weight = 0.3;
  double stay = 60.0;
  double accept = 60.0;
  double sure = 0.5;
  double settle_within = 60.0;  // m
  double agreement = 3.0;       // s
  double min_speed = 1.0;       // m/s
  double distance_unit = 8.0;   // m
  double hdop_unit = 4.0;       // m
  double visual_gate = 0.052;   // rad
  bool paths = true;
  double max_gap = 10.0;  // s
};

}  // namespace maploop::mapmatch
