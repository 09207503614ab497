// What the PPP filter can be told. Defaults fit a geodetic receiver with precise products.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace maploop::ppp {

enum class Motion : std::uint8_t { fixed, kinematic };
constexpr std::array<std::string_view, 2> names_of(Motion) {
  return {"static", "kinematic"};
}

struct PppParameters {
  Motion motion = Motion::kinematic;
  std::string systems = "GREC";  // letters of RINEX
  double elevation_mask = 7.0;   // degrees
  double cn0_mask = 0.0;         // dB-Hz
  // Standard deviation at the zenith, of one carrier; combinations enlarge it.
  double code_sigma = 0.4;           // m
  double phase_sigma = 0.003;        // m
  double doppler_sigma = 0.10;       // m/s
  double glonass_code_factor = 3.0;  // channels have biases of their own
  // How long errors of code last: multipath, and GLONASS's biases.
  double code_correlation = 40.0;            // s, of an antenna at rest; 0: not at all
  double code_correlation_distance = 50.0;   // m, that an antenna moves meanwhile
  double glonass_code_correlation = 7200.0;  // s
  // Codes whose residuals are larger than that come by reflections, which last longer.
  double code_level_time = 100.0;      // s, that residuals are remembered
  double reflection_time = 600.0;      // s, of an antenna at rest
  double reflection_distance = 500.0;  // m, that an antenna moves meanwhile
  // At the zenith and its drop to the horizon, with sin E between: a little less than signals have
  // without obstacles (5 % of those of three receivers under open sky are weaker). Below it,
  // variances double every 1.5 dB; 0: strength does not count.
  double full_cn0 = 47.0;       // dB-Hz
  double full_cn0_drop = 14.5;  // dB
  // What three quarters of a receiver's signals at an elevation do not exceed is so much more than
  // what they have at least without obstacles (1 to 5 dB with those three).
  double full_cn0_margin = 4.0;    // dB
  double zenith_wet_sigma = 0.06;  // m, what the climatology leaves: 5 cm and a little
  double zenith_wet_walk = 1e-4;   // m/sqrt(s)
  bool gradients = true;
  double gradient_sigma = 0.001;  // m
  double gradient_walk = 3e-6;    // m/sqrt(s)
  // White acceleration, m^2/s^3.
  double horizontal_acceleration = 2.0;
  double vertical_acceleration = 0.2;
  double ambiguity_sigma = 60.0;  // m
  // m/sqrt(s), besides that of the clocks: errors of orbits, attitude, antennas and troposphere.
  // From how post-fit phase residuals of a station change over 10 minutes, alike for all systems.
  double ambiguity_walk = 1.1e-4;
  double system_offset_walk = 1e-3;  // m/sqrt(s), clocks of systems against each other
  double position_sigma = 60.0;      // m, about the first position by code
  // m, an axis: what calibrations of antennas, tides and frames leave in common to all satellites,
  // which no residual shows; added to the covariance that is said.
  double model_sigma = 0.01;
  double outlier_sigmas = 4.0;  // post-fit
  double code_gate = 30.0;      // m, pre-fit
  bool graphic = true;          // one frequency: half the sum of code and phase
  int longest_gap = 10;         // epochs that a satellite may be away and keep its ambiguity
  // Of a receiver with one frequency, which mostly is a cheap one.
  double single_code_sigma = 1.0;     // m
  double single_phase_sigma = 0.005;  // m

  // --- The road that map matching has found
  // Share of the map's standard deviation that the filter's own without the map must exceed across
  // the road: a map is good to metres, a converged position to decimetres.
  double map_useful_share = 0.3;
  double map_gate = 6.63;            // chi-square, 1 degree of freedom, 1 % tail
  double map_slip = 0.1;             // m/s across a straight road, besides the azimuth's error
  double map_reach = 0.5;            // s, of an epoch from the feedback's stamp
  double map_datum_sigma = 1.0;      // m an axis, of the whole map against the orbits' frame
  double map_lasting_time = 3600.0;  // s, of errors of broadcast orbits, clocks and ionosphere
  double map_lasting_share = 0.8;    // of the position's variance is theirs at most
  double map_lane_length = 300.0;    // m of way in which a lane and the map's error change
  double map_lane_lasting = 0.3;     // share of them that goes on behind a turn: the side driven on
  // When the filter with the map is too far from the one without to be right.
  double map_difference_gate = 9.21;  // chi-square, 2 degrees of freedom, 1 % tail
  double map_patience = 5.0;          // s so far apart, or ...
  int map_most_gated = 5;             // lines gated in a row: a wrong road
  double map_pause = 10.0;  // s without the map behind it, doubled each time up to 16 times
};

inline PppParameters for_one_frequency(PppParameters p) {
  p.code_sigma = p.single_code_sigma;
  p.phase_sigma = p.single_phase_sigma;
  return p;
}

// Calls f(name, member) for each; Parameters is PppParameters, const or not.
template <class Parameters, class F>
requires std::same_as<std::remove_const_t<Parameters>, PppParameters>
void fields(Parameters& p, F&& f) {
  f("motion", p.motion);
  f("elevation_mask", p.elevation_mask);
  f("cn0_mask", p.cn0_mask);
  f("code_sigma", p.code_sigma);
  f("phase_sigma", p.phase_sigma);
  f("doppler_sigma", p.doppler_sigma);
  f("glonass_code_factor", p.glonass_code_factor);
  f("code_correlation", p.code_correlation);
  f("code_correlation_distance", p.code_correlation_distance);
  f("glonass_code_correlation", p.glonass_code_correlation);
  f("code_level_time", p.code_level_time);
  f("reflection_time", p.reflection_time);
  f("reflection_distance", p.reflection_distance);
  f("full_cn0", p.full_cn0);
  f("full_cn0_drop", p.full_cn0_drop);
  f("full_cn0_margin", p.full_cn0_margin);
  f("zenith_wet_sigma", p.zenith_wet_sigma);
  f("zenith_wet_walk", p.zenith_wet_walk);
  f("gradients", p.gradients);
  f("gradient_sigma", p.gradient_sigma);
  f("gradient_walk", p.gradient_walk);
  f("horizontal_acceleration", p.horizontal_acceleration);
  f("vertical_acceleration", p.vertical_acceleration);
  f("ambiguity_sigma", p.ambiguity_sigma);
  f("ambiguity_walk", p.ambiguity_walk);
  f("system_offset_walk", p.system_offset_walk);
  f("position_sigma", p.position_sigma);
  f("model_sigma", p.model_sigma);
  f("outlier_sigmas", p.outlier_sigmas);
  f("code_gate", p.code_gate);
  f("graphic", p.graphic);
  f("longest_gap", p.longest_gap);
  f("single_code_sigma", p.single_code_sigma);
  f("single_phase_sigma", p.single_phase_sigma);
  f("map_useful_share", p.map_useful_share);
  f("map_gate", p.map_gate);
  f("map_slip", p.map_slip);
  f("map_reach", p.map_reach);
  f("map_datum_sigma", p.map_datum_sigma);
  f("map_lasting_time", p.map_lasting_time);
  f("map_lasting_share", p.map_lasting_share);
  f("map_lane_length", p.map_lane_length);
  f("map_lane_lasting", p.map_lane_lasting);
  f("map_difference_gate", p.map_difference_gate);
  f("map_patience", p.map_patience);
  f("map_most_gated", p.map_most_gated);
  f("map_pause", p.map_pause);
}

}  // namespace maploop::ppp
