#include "ppp/filter/parameter_table.h"

#include "ppp/filter/data_choices.h"
#include "ppp/satellite.h"

namespace maploop::ppp {

ParameterTable<PppParameters> parameter_table(const PppParameters&) {
  using enum Audience;
  using P = PppParameters;
  constexpr double long_time = 1e7;  // s
  constexpr double any_sigma = 1e4;  // m
  constexpr double any_gate = 1e9;   // a larger one lets everything through
  constexpr double smallest = 1e-6;  // of what is divided by
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"motion", one_of<&P::motion>, usual, "Whether the receiver moves."},
      {"systems", &P::systems, usual,
       "Satellite systems used, by their letters in RINEX: G GPS, R GLONASS, E Galileo, C BeiDou, "
       "J QZSS, S SBAS, I NavIC."},
      {"elevation_mask", &P::elevation_mask, 0.0, 90.0, "deg", usual,
       "Satellites at a lower elevation are not used."},
      {"cn0_mask", &P::cn0_mask, 0.0, 100.0, "dB-Hz", usual,
       "Signals of a lower carrier-to-noise density are not used."},
      {"code_sigma", &P::code_sigma, smallest, any_sigma, "m", expert,
       "Standard deviation of the code of one carrier at the zenith, of what is its own.",
       code_sigma_choice},
      {"common_code_sigma", &P::common_code_sigma, 0.0, any_sigma, "m", expert,
       "Standard deviation of what the codes of a satellite's carriers have in common besides, "
       "such as reflections.",
       common_sigma_choice},
      {"phase_sigma", &P::phase_sigma, smallest, any_sigma, "m", expert,
       "Standard deviation of the phase of one carrier, of what is its own.", phase_sigma_choice},
      {"common_phase_sigma", &P::common_phase_sigma, 0.0, any_sigma, "m", expert,
       "Standard deviation of what the phases of a satellite's carriers have in common besides.",
       common_sigma_choice},
      {"phase_correlation", &P::phase_correlation, 0.0, long_time, "s", expert,
       "Correlation time of what the phases have in common. 0: not correlated.",
       phase_correlation_choice},
      {"shadow_phase_factor", &P::shadow_phase_factor, 1.0, 1000.0, "1", expert,
       "Factor on phase_sigma for satellites in the earth's shadow, whose attitude is not known."},
      {"doppler_sigma", &P::doppler_sigma, smallest, any_sigma, "m/s", expert,
       "The same for the Doppler shift."},
      {"reflected_doppler", &P::reflected_doppler, 0.0, 10.0, "1", expert,
       "Standard deviation of the Doppler shift of a signal that is surely reflected, as a share "
       "of the speed.",
       reflections_choice},
      {"glonass_code_factor", &P::glonass_code_factor, smallest, 1000.0, "1", expert,
       "Factor on code_sigma for GLONASS, whose channels have biases of their own."},
      {"code_correlation", &P::code_correlation, 0.0, long_time, "s", expert,
       "Correlation time of the code errors (multipath) of an antenna at rest. 0: not correlated.",
       code_correlation_choice},
      {"code_correlation_distance", &P::code_correlation_distance, smallest, 1e6, "m", expert,
       "Way of the antenna over which the code errors are correlated.",
       code_correlation_distance_choice},
      {"glonass_code_correlation", &P::glonass_code_correlation, 0.0, long_time, "s", expert,
       "Correlation time of the code biases of the GLONASS channels.",
       glonass_code_correlation_choice},
      {"first_code_factor", &P::first_code_factor, 1.0, 1000.0, "1", expert,
       "Factor on the variance of a satellite's first code if obstacles have weakened its "
       "signal to nothing: its error lasts.",
       reflections_choice},
      {"late_code_freedom", &P::late_code_freedom, smallest, 1e9, "1", expert,
       "Degrees of freedom of the errors of codes that are too long: a residual of as many "
       "variances doubles the variance.",
       reflections_choice},
      {"code_level_time", &P::code_level_time, 0.1, long_time, "s", expert,
       "Time for which a satellite's code residuals are remembered. Larger residuals than expected "
       "come from reflections and enlarge the variance.",
       reflections_choice},
      {"full_cn0", &P::full_cn0, 0.0, 100.0, "dB-Hz", expert,
       "Carrier-to-noise density of a signal without obstacles at the zenith; 5 % of the signals "
       "of three receivers under open sky are weaker. Below it the variance doubles every 1.5 dB. "
       "0: the strength does not count.",
       full_cn0_choice},
      {"full_cn0_drop", &P::full_cn0_drop, 0.0, 100.0, "dB", expert,
       "Decrease of full_cn0 from the zenith to the horizon, with the sine of the elevation.",
       full_cn0_drop_choice},
      {"full_cn0_margin", &P::full_cn0_margin, 0.0, 100.0, "dB", expert,
       "Difference between the level that three quarters of this receiver's signals at an "
       "elevation do not exceed and full_cn0 there: 1 to 5 dB with those three receivers. Where "
       "the level less this margin is higher than full_cn0, it counts instead.",
       full_cn0_margin_choice},
      {"full_cn0_step", &P::full_cn0_step, 0.0, 10.0, "dB", expert,
       "Change of that level per signal; it follows the signals of the last minutes."},
      {"full_cn0_first_step", &P::full_cn0_first_step, 0.0, 20.0, "dB", expert,
       "The same for the first signal at an elevation, half of it for the second, a third for the "
       "third, and so on: a receiver that starts between houses must know its level at once.",
       full_cn0_first_step_choice},
      {"zenith_wet_sigma", &P::zenith_wet_sigma, 0.0, 10.0, "m", expert,
       "Standard deviation of the zenith wet delay about the climatology."},
      {"zenith_wet_walk", &P::zenith_wet_walk, 0.0, 1.0, "m/sqrt(s)", expert,
       "Random walk of the zenith wet delay."},
      {"gradients", &P::gradients, expert,
       "Whether horizontal gradients of the troposphere are estimated."},
      {"gradient_sigma", &P::gradient_sigma, 0.0, 1.0, "m", expert,
       "Standard deviation of a gradient at the start."},
      {"gradient_walk", &P::gradient_walk, 0.0, 1.0, "m/sqrt(s)", expert,
       "Random walk of a gradient."},
      {"horizontal_acceleration", &P::horizontal_acceleration, 0.0, 1e4, "m^2/s^3", usual,
       "Power spectral density of the white horizontal acceleration of a moving receiver.",
       reflections_choice},
      {"vertical_speed_sigma", &P::vertical_speed_sigma, smallest, 1e4, "m/s", usual,
       "Standard deviation of the vertical speed of a moving receiver, which the slopes of roads "
       "bound.",
       vertical_speed_choice},
      {"vertical_speed_time", &P::vertical_speed_time, smallest, long_time, "s", usual,
       "Correlation time of that speed.", vertical_speed_choice},
      {"carried_by_motion", &P::carried_by_motion, usual,
       "Whether a replay's or a vehicle's own motion (odometry, wheels, inertial unit) moves the "
       "position from epoch to epoch, in place of a constant velocity."},
      {"carried_walk", &P::carried_walk, smallest, any_sigma, "m/sqrt(s)", expert,
       "White error of such a motion, along each axis.", carried_choice},
      {"carried_velocity_sigma", &P::carried_velocity_sigma, smallest, any_sigma, "m/s", expert,
       "White error of its velocity.", carried_choice},
      {"carried_speed_share", &P::carried_speed_share, 0.0, 1.0, "1", expert,
       "Standard deviation of the speed's error in an interval, as a share of it: wheels slip.",
       carried_choice},
      {"carried_turn_sigma", &P::carried_turn_sigma, 0.0, 1.0, "rad", expert,
       "Least standard deviation of the lasting error of its direction."},
      {"carried_turn_time", &P::carried_turn_time, smallest, long_time, "s", expert,
       "Correlation time of this error."},
      {"carried_scale_sigma", &P::carried_scale_sigma, 0.0, 1.0, "1", expert,
       "Standard deviation of the lasting error of its length, as a share of it."},
      {"carried_scale_time", &P::carried_scale_time, smallest, long_time, "s", expert,
       "Correlation time of this error."},
      {"ionosphere_walk", &P::ionosphere_walk, 0.0, 1.0, "m/sqrt(s)", expert,
       "Random walk of the error of the ionosphere's model at the zenith."},
      {"slant_ionosphere_walk", &P::slant_ionosphere_walk, 0.0, 1.0, "m/sqrt(s)", expert,
       "Random walk of a satellite's own error of the ionosphere's model."},
      {"measured_ionosphere_walk", &P::measured_ionosphere_walk, 0.0, 1.0, "m/sqrt(s)", expert,
       "The same for a satellite whose ionosphere is measured by two carriers: a larger walk costs "
       "little there.",
       measured_ionosphere_walk_choice},
      {"slant_ionosphere_share", &P::slant_ionosphere_share, smallest, 1.0, "1", expert,
       "Share of the standard deviation of the ionosphere's model that is each satellite's own."},
      {"ionosphere_gradient_share", &P::ionosphere_gradient_share, smallest, 100.0, "1", expert,
       "Standard deviation of the change of the error at the zenith over 1000 km, of its own."},
      {"unknown_bias_sigma", &P::unknown_bias_sigma, smallest, 1e3, "m", expert,
       "Standard deviation of the ionosphere that products without biases of codes add."},
      {"range_error_time", &P::range_error_time, 0.1, long_time, "s", expert,
       "Correlation time of the errors of broadcast orbits and clocks.", range_error_time_choice},
      {"ambiguity_sigma", &P::ambiguity_sigma, smallest, 1e6, "m", expert,
       "Standard deviation of an ambiguity at the start."},
      {"ambiguity_walk", &P::ambiguity_walk, 0.0, 1.0, "m/sqrt(s)", expert,
       "Random walk of the ambiguities besides that of the clocks: errors of orbits, attitude, "
       "antennas and troposphere. It comes from the changes of a station's post-fit phase "
       "residuals over 10 minutes and is the same for all systems.",
       ambiguity_walk_choice},
      {"system_offset_walk", &P::system_offset_walk, 0.0, 1000.0, "m/sqrt(s)", expert,
       "Random walk of the clocks of the systems against each other."},
      {"code_difference_sigma", &P::code_difference_sigma, smallest, 1e6, "m", expert,
       "Standard deviation of half the receiver's delay of a system's second code beyond its "
       "first."},
      {"source_change_sigma", &P::source_change_sigma, 0.0, any_sigma, "m", expert,
       "Standard deviation of the difference between the ranges by two sources of orbits and "
       "clocks. It is added to the ambiguity when a satellite's source changes."},
      {"clock_sigma", &P::clock_sigma, smallest, 1e6, "m", expert,
       "Standard deviation of a clock, or of a system's offset, that is set from the codes."},
      {"clock_difference_sigma", &P::clock_difference_sigma, smallest, 1e6, "m", expert,
       "Standard deviation of a receiver's delay of one system against another's. Where it is "
       "more than three times that, it is estimated from the codes alone.",
       clock_difference_choice},
      {"drift_sigma", &P::drift_sigma, smallest, 1e6, "m/s", expert,
       "Standard deviation of the clock's drift, which is set from the Doppler shifts."},
      {"position_sigma", &P::position_sigma, smallest, 1e6, "m", expert,
       "Standard deviation of the first position, which comes from the code."},
      {"velocity_sigma", &P::velocity_sigma, smallest, 1e4, "m/s", expert,
       "Standard deviation per axis of the first velocity of a moving receiver."},
      {"lost_position_sigma", &P::lost_position_sigma, smallest, any_gate, "m", expert,
       "Standard deviation of the predicted position beyond which it begins anew with the codes."},
      {"bridged_sigma", &P::bridged_sigma, 0.0, any_sigma, "m", expert,
       "Horizontal standard deviation up to which the positions of `maploop ppp` are bridged."},
      {"model_sigma", &P::model_sigma, 0.0, 100.0, "m", expert,
       "Standard deviation per axis of the errors of antennas, tides and frames that are common to "
       "all satellites, which no residual shows. It is added to the reported covariance."},
      {"outlier_sigmas", &P::outlier_sigmas, 0.1, any_gate, "1", expert,
       "Post-fit residual in standard deviations beyond which a measurement is an outlier.",
       outlier_sigmas_choice},
      {"obstructed_outlier_sigmas", &P::obstructed_outlier_sigmas, 0.1, any_gate, "1", expert,
       "The same for phases and Doppler shifts of signals that obstacles have weakened to nothing.",
       reflections_choice},
      {"outlier_rejections", &P::outlier_rejections, 0, 100, "rows", expert,
       "Measurements of an epoch that are left out one at a time at most."},
      {"doubtful_phase_sigma", &P::doubtful_phase_sigma, 0.0, any_sigma, "m", expert,
       "Additional standard deviation of the phases of an epoch in which too few of them fit to "
       "tell the wrong ones from the right ones."},
      {"code_gate", &P::code_gate, 0.1, any_gate, "m", expert,
       "Pre-fit code residual beyond which a measurement is left out."},
      {"code_gate_sigmas", &P::code_gate_sigmas, 0.0, 1000.0, "1", expert,
       "Standard deviations of the position by which this gate is wider: after a gap the position "
       "is wrong for all codes."},
      {"longest_gap", &P::longest_gap, 0, 1e6, "epochs", expert,
       "Epochs for which a satellite may be missing and keep its ambiguity."},
      {"longest_pause", &P::longest_pause, 0.0, long_time, "s", expert,
       "Time for which all epochs may be missing, likewise; with one carrier, a minute at most."},
      {"restart_epochs", &P::restart_epochs, 1, 1e6, "epochs", expert,
       "Epochs in a row in which measurements disagree with the position until the filter "
       "restarts.",
       reflections_choice},
      {"restart_variance", &P::restart_variance, 1.0, any_gate, "1", expert,
       "Mean square of the codes' residuals in standard deviations beyond which they disagree."},

      {"slip_geometry_free", &P::slip_geometry_free, 0.0, any_sigma, "m", expert,
       "Departure of the geometry-free phase from its rate that is a slip."},
      {"slip_phase_step", &P::slip_phase_step, 0.0, any_sigma, "m", expert,
       "Departure of a phase from the common step of all phases, on one frequency, that is a slip: "
       "a quarter of a cycle."},
      {"slip_growth", &P::slip_growth, 0.0, 100.0, "m/s", expert,
       "Growth of these two limits with the time since the last phase: the drift of ionosphere and "
       "clocks."},
      {"slip_low_elevation", &P::slip_low_elevation, 0.0, 1.5707963267948966, "rad", expert,
       "Elevation below which these limits are twice as large."},
      {"slip_wide_lanes", &P::slip_wide_lanes, 0.0, 1000.0, "1", expert,
       "Departure of the Melbourne-Wuebbena combination from its mean, in wide lanes, that is a "
       "slip."},
      {"slip_doppler", &P::slip_doppler, 0.0, any_sigma, "m", expert,
       "Departure of the phase from the integral of the Doppler shift, on one frequency, that is a "
       "slip. It grows by the same per second."},

      {"start_model_variance", &P::start_model_variance, 0.0, 1e6, "m^2", expert,
       "Variance of a range that is added for the models in the first position."},
      {"start_outlier_sigmas", &P::start_outlier_sigmas, 0.1, any_gate, "1", expert,
       "Residual in standard deviations beyond which a code is left out of the first position."},
      {"start_outlier_share", &P::start_outlier_share, 0.0, 1.0, "1", expert,
       "Share of the satellites that may be left out of the first position."},
      {"start_largest_residual", &P::start_largest_residual, 0.1, any_gate, "1", expert,
       "Residual in standard deviations beyond which there is no first position."},

      {"integers", &P::integers, usual,
       "Whether ambiguities are resolved to integers where the products contain the biases of the "
       "phases."},
      {"integer_elevation", &P::integer_elevation, 0.0, 90.0, "deg", expert,
       "Ambiguities of satellites at a lower elevation are not resolved."},
      {"wide_lane_sigma", &P::wide_lane_sigma, smallest, 10.0, "cycles", expert,
       "Standard deviation of what is left of the error of a wide lane that codes and phases have "
       "measured for hours.",
       wide_lane_sigma_choice},
      {"integer_success", &P::integer_success, 0.0, 1.0, "1", expert,
       "Least probability, by the covariance of the ambiguities, that the integers are right.",
       integer_success_choice},
      {"integer_margin", &P::integer_margin, 0.0, any_gate, "1", expert,
       "Least difference of the squared distances of the second best integers and the best, in "
       "variances, or in misfits of the best if these are larger.",
       integer_margin_choice},
      {"integer_misfit", &P::integer_misfit, smallest, any_gate, "1", expert,
       "Largest squared distance of the best integers, for each of them, in variances."},
      {"integer_fewest", &P::integer_fewest, 1, 100, "1", expert,
       "Fewest combinations of ambiguities whose integers are used together, and fewest satellites "
       "whose ambiguities are integers in a position that is called fixed."},
      {"integer_confirmation", &P::integer_confirmation, 0.0, long_time, "s", expert,
       "Time for which the integers must not have changed before they are used."},

      {"map_useful_share", &P::map_useful_share, 0.0, 1000.0, "1", expert,
       "Ratio of the standard deviation across the road without the map to that of the map from "
       "which the map is used. A map is good to metres, a converged position to decimetres."},
      {"map_gate", &P::map_gate, 0.0, any_gate, "1", expert,
       "Gate of a road line or of its direction (chi-square, 1 degree of freedom); the default has "
       "a tail of 1 %."},
      {"map_slip", &P::map_slip, smallest, 100.0, "m/s", expert,
       "Standard deviation of the speed across a straight road, besides the error of its azimuth."},
      {"map_reach", &P::map_reach, 0.0, 60.0, "s", expert,
       "Largest time between an epoch and the stamp of the feedback."},
      {"map_datum_sigma", &P::map_datum_sigma, 0.0, 1000.0, "m", usual,
       "Standard deviation per axis of the whole map against the frame of the orbits."},
      {"map_lane_length", &P::map_lane_length, 0.1, 1e6, "m", expert,
       "Way over which the lane and the error of the map change."},
      {"map_lane_lasting", &P::map_lane_lasting, 0.0, 1.0, "1", expert,
       "Share of that error that persists after a turn: the side of the road that is driven on."},
      {"map_difference_gate", &P::map_difference_gate, 0.0, any_gate, "1", expert,
       "Distance of the position with the map from the one without beyond which the road may be "
       "wrong (chi-square, 3 degrees of freedom); the default has a tail of 1 %."},
      {"map_patience", &P::map_patience, 0.0, long_time, "s", expert,
       "Time for which the two positions are that far apart until the road is taken to be wrong."},
      {"map_most_gated", &P::map_most_gated, 1, 1e6, "lines", expert,
       "Road lines gated in a row after which the road is taken to be wrong."},
      {"map_agreement_gate", &P::map_agreement_gate, 0.0, any_gate, "1", expert,
       "Distance of the two positions up to which, if lines contradict the filter, only the map is "
       "paused (chi-square, 3 degrees of freedom); the default contains 68 %."},
      {"map_pause", &P::map_pause, 0.0, long_time, "s", expert,
       "Time without the map after a wrong road. It is doubled each time."},
      {"map_pause_doublings", &P::map_pause_doublings, 0, 20, "1", expert,
       "How often that time is doubled at most."},
      {"map_trusted_again", &P::map_trusted_again, 0.0, long_time, "s", expert,
       "Time without a wrong road after which a pause is as long as the first one again."},
  });
  const auto rules = [](const P& p) -> std::optional<ParameterProblem> {
    if (p.systems.empty()) return {{"systems", "is empty; allowed are the letters G R E C J S I"}};
    for (const char letter : p.systems) {
      if (!system_of(letter)) {
        return {
            {"systems", "is \"" + p.systems + "\"; '" + letter + "' is not one of G R E C J S I"}};
      }
    }
    return std::nullopt;
  };
  return {"ppp", "Precise point positioning with the observations of a GNSS receiver.", table,
          rules};
}

}  // namespace maploop::ppp
