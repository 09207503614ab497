// Parameters of the PPP filter; parameter_table.cpp describes each. The defaults fit a geodetic
// receiver with precise products.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace maploop::ppp {

// States whether the antenna is at rest or moves.
enum class Motion : std::uint8_t { fixed, kinematic };
constexpr std::array<std::string_view, 2> names_of(Motion) {
  return {"static", "kinematic"};
}

// How the height of the ground is used; ground_parameter_table.cpp describes each.
struct GroundParameters {
  double antenna_height = 1.7;   // m
  double surface = 3.0;          // m
  double datum_sigma = 4.0;      // m
  double no_geoid_sigma = 30.0;  // m
  double error_sigma = 3.0;      // m
  double error_length = 300.0;   // m
  double noise = 0.5;            // m
  double slope_sigma = 0.05;     // m/m, of the model's slope
  double gate = 9.0;             // squared innovation, over its variance, that is still used
};

// Holds the parameters of the filter, of its first position, of its integers and of its use of the
// road.
struct PppParameters {
  Motion motion = Motion::kinematic;         // whether the receiver moves
  std::string systems = "GREC";              // those used, by their letters in RINEX (satellite.h)
  double elevation_mask = 7.0;               // deg
  double cn0_mask = 0.0;                     // dB-Hz
  double code_sigma = 0.4;                   // m, of each carrier's own
  double common_code_sigma = 0.9;            // m, of the error that the carriers have in common
  double phase_sigma = 0.003;                // m, of each carrier's own
  double common_phase_sigma = 0.002;         // m
  double phase_correlation = 10.0;           // s, of the error that the carriers have in common
  double shadow_phase_factor = 4.0;          // on phase_sigma in the earth's shadow
  double doppler_sigma = 0.10;               // m/s
  double reflected_doppler = 0.3;            // sigma of a reflected one, as a share of the speed
  double glonass_code_factor = 3.0;          // on code_sigma for GLONASS
  double code_correlation = 40.0;            // s
  double code_correlation_distance = 50.0;   // m
  double glonass_code_correlation = 7200.0;  // s
  double first_code_factor = 2.0;            // on the variance of an obstructed first code
  double late_code_freedom = 4.0;            // degrees of freedom of codes that are too long
  double code_level_time = 30.0;             // s
  double full_cn0 = 47.0;                    // dB-Hz
  double full_cn0_drop = 14.5;               // dB
  double full_cn0_margin = 4.0;              // dB
  double full_cn0_step = 0.1;                // dB
  double full_cn0_first_step = 4.0;          // dB
  double zenith_wet_sigma = 0.06;            // m
  double zenith_wet_walk = 1e-4;             // m/sqrt(s)
  bool gradients = true;                     // whether the troposphere's are estimated
  double gradient_sigma = 0.001;             // m
  double gradient_walk = 3e-6;               // m/sqrt(s)
  double horizontal_acceleration = 4.0;      // m^2/s^3
  double vertical_speed_sigma = 0.5;         // m/s
  double vertical_speed_time = 20.0;         // s
  bool carried_by_motion = true;             // whether the vehicle's own motion moves the position
  double carried_walk = 0.02;                // m/sqrt(s)
  double carried_velocity_sigma = 0.1;       // m/s
  double carried_speed_share = 0.1;          // sigma of the speed's error, as a share of the speed
  double carried_turn_sigma = 0.02;          // rad
  double carried_turn_time = 60.0;           // s
  double carried_scale_sigma = 0.01;         // lasting error of the motion's length, as a share
  double carried_scale_time = 300.0;         // s
  double ionosphere_walk = 1e-3;             // m/sqrt(s), at the zenith
  double slant_ionosphere_walk = 3e-3;       // m/sqrt(s)
  double measured_ionosphere_walk = 1e-2;    // m/sqrt(s)
  double slant_ionosphere_share = 0.5;       // of the model's sigma that is each satellite's own
  double ionosphere_gradient_share = 0.5;    // for each 1000 km
  double unknown_bias_sigma = 5.0;           // m
  double range_error_time = 43200.0;         // s
  double ambiguity_sigma = 60.0;             // m
  double ambiguity_walk = 1.1e-4;            // m/sqrt(s)
  double system_offset_walk = 1e-3;          // m/sqrt(s)
  double code_difference_sigma = 10.0;       // m
  double source_change_sigma = 2.0;          // m
  double clock_sigma = 100.0;                // m
  double clock_difference_sigma = 10.0;      // m
  double drift_sigma = 100.0;                // m/s
  double position_sigma = 60.0;              // m
  double velocity_sigma = 10.0;              // m/s
  double lost_position_sigma = 500.0;        // m, beyond which the position begins anew
  double bridged_sigma = 30.0;               // m, horizontally, up to which positions are bridged
  double model_sigma = 0.01;                 // m
  double outlier_sigmas = 3.0;               // post-fit residual beyond which there is an outlier
  double obstructed_outlier_sigmas = 2.0;    // the same of obstructed phases and Dopplers
  int outlier_rejections = 8;                // most measurements of an epoch left out singly
  double doubtful_phase_sigma = 1.0;         // m
  double code_gate = 30.0;                   // m
  double code_gate_sigmas = 4.0;             // of the position, by which code_gate is wider
  int longest_gap = 10;           // epochs that a satellite may miss and keep its ambiguity
  double longest_pause = 600.0;   // s, that all epochs may be missing, likewise
  int restart_epochs = 10;        // epochs in a row that disagree until the filter restarts
  double restart_variance = 9.0;  // mean square of normalized code residuals that disagrees

  // --- Slips
  double slip_geometry_free = 0.04;  // m
  double slip_phase_step = 0.05;     // m
  double slip_growth = 0.002;        // m/s
  double slip_low_elevation = 0.26;  // rad
  double slip_wide_lanes = 1.2;      // departure from the mean wide lane, in wide lanes
  double slip_doppler = 0.5;         // m

  // --- The first position
  double start_model_variance = 0.01;    // m^2
  double start_outlier_sigmas = 4.0;     // residual beyond which a code is left out
  double start_outlier_share = 0.25;     // of the satellites, which may be left out
  double start_largest_residual = 10.0;  // in sigmas; beyond it there is no first position

  // --- Integers
  bool integers = true;                // whether ambiguities are resolved to integers
  double integer_elevation = 10.0;     // deg
  double wide_lane_sigma = 0.1;        // cycles
  double integer_success = 0.97;       // least probability that the integers are right
  double integer_margin = 15.0;        // least margin of the best to the second best, in variances
  double integer_misfit = 3.0;         // largest squared distance for each integer, in variances
  int integer_fewest = 4;              // fewest combinations that are used together
  double integer_confirmation = 30.0;  // s

  // --- The road that map matching has found
  double map_useful_share = 0.3;       // least ratio of the map-free sigma to the map's
  double map_gate = 6.63;              // of a line or direction, chi-square (1 degree of freedom)
  double map_slip = 0.1;               // m/s
  double map_reach = 0.5;              // s
  double map_datum_sigma = 1.0;        // m
  double map_lane_length = 300.0;      // m
  double map_lane_lasting = 0.3;       // share of the lane's error that persists after a turn
  double map_difference_gate = 11.34;  // beyond it the road may be wrong, chi-square (3)
  double map_patience = 5.0;           // s
  int map_most_gated = 5;              // lines gated in a row after which the road is wrong
  double map_agreement_gate = 3.5;     // up to it the map is only paused, chi-square (3)
  double map_pause = 10.0;             // s
  int map_pause_doublings = 4;         // how often map_pause is doubled at most
  double map_trusted_again = 300.0;    // s

  GroundParameters ground;  // how the ground's height is used
};

}  // namespace maploop::ppp
