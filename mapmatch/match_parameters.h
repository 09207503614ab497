// Parameters of map matching. parameter_fields.h names each for files and archives.
#pragma once

namespace maploop::mapmatch {

struct MatchParameters {
  // --- The map
  double map_sigma = 3.5;       // m a axis: centre lines, lanes and datum; constant over some 100 m
  double road_noise = 2.0;      // m a axis: what of it changes from second to second
  double link_memory = 0.1;     // share of the map's error that goes on behind a junction
  double azimuth_noise = 0.14;  // rad: links' azimuths and the vehicle's own way round bends
  double wrong_way = 5.0;       // -ln P of driving against a one-way street
  double banned_turn = 3.0;     // -ln P
  double minor_road = 1.0;      // -ln P of a service way, track or road that is not public
  double turn_round = 4.0;      // -ln P of a U-turn

  // --- The fixes' errors
  double correlation_time = 30.0;  // s, of the part of them that does not change from fix to fix
  double distance_scale = 0.03;    // error of distance travelled, share
  double corner = 2.0;             // m a root radian turned that a vehicle cuts corners by
  double gate = 25.0;              // innovation squared, in sigmas, that a fix may be off

  // --- Path hypotheses
  double lookahead = 15.0;       // m before a junction where its exits become hypotheses
  double birth = 7.0;            // -ln P a second that the vehicle is where no hypothesis is
  double prune = 14.0;           // -ln of the share below the best's where a hypothesis ends
  double memory = 60.0;          // s in which evidence loses 1 - 1/e of its weight
  double position_weight = 1.0;  // of positions as evidence
  double azimuth_weight = 0.7;   // of azimuths as evidence, a second

  // --- Off the road
  double misfit = 12.0;  // sigmas squared of offset and azimuth where a link no longer fits
  double wrong_way_misfit = 6.0;  // of driving against a one-way street
  double misfit_rate = 0.5;       // of offsets as evidence between links, a second
  double trust = 5.0;             // log odds of a link that fits perfectly; and what
  double trust_slope = 0.8;       // a unit of misfit takes from them (the reliability diagram)
  double doubt_slope = 0.15;      // of the log odds below those of 0.9, which sink no faster
  double off_road_rate = 1.0;     // evidence a second, a unit of misfit

  // --- Fuzzy process
  double fuzzy_weight = 0.3;    // of ln(L/100) beside ln P of the paths
  double stay = 60.0;           // L2 from which the vehicle is still on its link
  double accept = 60.0;         // L3 of a link behind a junction; below it matching begins again
  double sure = 0.5;            // margin of P from which the link behind a junction is settled, ...
  double settle_within = 60.0;  // m, ... or this far behind it
  double agreement = 3.0;       // s that one link must win before it is accepted
  double min_speed = 1.0;       // m/s from which azimuths are believed
  double distance_unit = 8.0;   // m: sigma of the fixes that the rules' distances were made for
  double hdop_unit = 4.0;       // m of horizontal sigma that is an HDOP of 1
  double visual_gate = 0.052;   // rad in a second that visual odometry may differ by; 0: not used
  bool paths = true;            // path hypotheses beside the rules
  double max_gap = 10.0;        // s without a fix, after which matching begins again
};

}  // namespace maploop::mapmatch
