#include "estimators/fusion/parameter_table.h"

#include "estimators/fusion/data_choices.h"

namespace maploop::fusion {

ParameterTable<FusionParameters> parameter_table(const FusionParameters&) {
  using enum Audience;
  using P = FusionParameters;
  constexpr double tiny = 1e-9, large = 1e6;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"use_gnss", &P::use_gnss, expert,
       "Whether fixes correct the state after the start, which always takes a fix. `configuration` "
       "sets it."},
      {"use_odometry_speed", &P::use_odometry_speed, expert,
       "Whether the forward speed of visual or visual-LiDAR odometry corrects the state. "
       "`configuration` sets it."},
      {"use_odometry_azimuth", &P::use_odometry_azimuth, expert,
       "Whether the rotation of odometry over each interval corrects the state. `configuration` "
       "sets it."},
      {"chain_odometry_azimuth", &P::chain_odometry_azimuth, expert,
       "Whether the rotations of odometry are added up to an azimuth of their own, as in the "
       "thesis."},
      {"use_wheel_speed", &P::use_wheel_speed, expert,
       "Whether the speed of the wheels corrects the state. `configuration` sets it."},
      {"use_zero_velocity", &P::use_zero_velocity, expert,
       "Whether the state is corrected to zero velocity while the vehicle is detected to stand "
       "still."},
      {"still_by_inertia", &P::still_by_inertia, expert,
       "Whether quiet inertial samples show by themselves that the vehicle stands still. "
       "`configuration` sets it where neither odometry nor wheels give a speed."},
      {"speed_from_turns", &P::speed_from_turns, expert,
       "Whether the centripetal force of a turn corrects the speed. `configuration` sets it where "
       "neither odometry nor wheels give a speed."},
      {"inertial_axes", one_of<&P::inertial_axes>, usual,
       "Axes of the inertial unit that are used where it has six. \"three\": two horizontal "
       "accelerometers and the vertical gyro, as in the thesis; \"auto\": six where neither "
       "odometry nor wheels give a speed, else three."},

      {"history_length", &P::history_length, 0.01, 60.0, "s", expert,
       "Age up to which late data is applied. Odometry is less than 0.3 s late."},
      {"history_capacity", &P::history_capacity, 8, 100'000, "events", expert,
       "Events of the history at most. 3 s of a 100 Hz inertial unit and 10 Hz odometry take about "
       "360."},
      {"confirm_gap", &P::confirm_gap, 0.01, 60.0, "s", expert,
       "A stamp that is further ahead needs a second one that agrees with it. At most "
       "history_length."},
      {"max_gap", &P::max_gap, 0.01, 60.0, "s", expert,
       "Time without data beyond which nothing is predicted, because the clock must have jumped. "
       "At least confirm_gap."},
      {"max_stamp_ahead", &P::max_stamp_ahead, 0.0, 60.0, "s", expert,
       "How far a stamp may be ahead of its delivery; the clocks of sensor and host agree better "
       "than that. At most confirm_gap."},
      {"restart_after", &P::restart_after, 2, large, "refusals", expert,
       "Refusals in a row because of their stamps after which the clock is taken to have jumped."},
      {"max_step", &P::max_step, 1e-3, 1.0, "s", expert,
       "Longest integration step. Over 0.05 s of a turn with 30 deg/s the chord is 3e-5 shorter "
       "than the arc."},
      {"imu_hold", &P::imu_hold, 0.0, 60.0, "s", expert,
       "Time for which an inertial sample is held: three missing samples of a 10 Hz unit. Then the "
       "unit is silent. At most history_length."},
      {"repeat_speed", &P::repeat_speed, 0.0, large, "m/s", expert,
       "Speed from which a unit that repeats its values for imu_hold is taken to be stuck.",
       repeat_speed_choice},
      {"imu_bridge", &P::imu_bridge, 0.0, 60.0, "s", expert,
       "Longest gap between two inertial samples that is interpolated; a longer one may hide a "
       "whole turn. From imu_hold to history_length."},
      {"coasting_after", &P::coasting_after, 0.0, large, "s", expert,
       "Time without odometry after which the state is reported as coasting."},
      {"max_interval", &P::max_interval, 1e-3, 60.0, "s", expert,
       "Longest interval of odometry that is used; speed is not constant for longer. At most "
       "max_gap."},
      {"max_origin_distance", &P::max_origin_distance, 0.0, 1e5, "m", expert,
       "Distance from the origin of the local frame up to which the plumb line is taken as linear "
       "in position."},

      {"min_course_speed", &P::min_course_speed, 0.1, large, "m/s", expert,
       "Speed from which the course of a fix starts the azimuth. There 0.1 m/s of velocity noise "
       "is 3 deg of course."},
      {"max_course_velocity_sigma", &P::max_course_velocity_sigma, 0.01, large, "m/s", expert,
       "Standard deviation of the horizontal velocity of a fix up to which its course starts the "
       "azimuth. Between houses, a first velocity that is less certain is often wrong by many.",
       course_velocity_choice},
      {"late_course_after", &P::late_course_after, 0.0, large, "s", expert,
       "Time since the first fix that moves, without such a velocity, after which a less certain "
       "one starts the azimuth, too: a receiver that measures no Doppler shifts has no better "
       "one."},
      {"late_course_sigma", &P::late_course_sigma, 0.01, 0.5, "rad", expert,
       "Standard deviation of the course of such a velocity, up to which it does. The filter is "
       "linear up to 0.35."},
      {"max_stamp_offset", &P::max_stamp_offset, 0.0, 2.0, "s", expert,
       "Largest difference between the stamps of a fix's position and velocity."},
      {"min_position_sigma", &P::min_position_sigma, tiny, large, "m", expert,
       "Least standard deviation of a fix's position, below which no receiver of a road vehicle "
       "comes."},
      {"min_velocity_sigma", &P::min_velocity_sigma, tiny, large, "m/s", expert,
       "Least standard deviation of a fix's velocity."},
      {"start_course_sigma", &P::start_course_sigma, tiny, 1.0, "rad", expert,
       "Standard deviation of the course against the body at the start: side slip and mounting."},
      {"start_slope_sigma", &P::start_slope_sigma, tiny, 1.0, "rad", expert,
       "Standard deviation of the climb against the pitch at the start: suspension."},
      {"road_slope_sigma", &P::road_slope_sigma, tiny, 1.0, "rad", expert,
       "Standard deviation of the slope of roads. It corrects the velocity of the fix that starts "
       "the filter: a car does not climb steeply."},
      {"start_roll_sigma", &P::start_roll_sigma, tiny, 1.0, "rad", expert,
       "Standard deviation of the roll at the start: cross fall of the road and suspension."},
      {"start_acceleration", &P::start_acceleration, 0.0, large, "m/s^2", expert,
       "Standard deviation of the change of speed between the two stamps of the first fix."},

      {"gyro_noise", &P::gyro_noise, tiny, 1.0, "rad/sqrt(s)", usual,
       "Angle random walk of the gyro. The default is that of a MEMS unit, 0.3 deg/sqrt(h)."},
      {"gyro_turn_on_sigma", &P::gyro_turn_on_sigma, tiny, 1.0, "rad/s", usual,
       "Standard deviation of the gyro bias at the start. The default is 36 deg/h; `imu_grade` "
       "sets it."},
      {"gyro_bias_sigma", &P::gyro_bias_sigma, tiny, 1.0, "rad/s", usual,
       "Standard deviation of the random walk of the gyro bias over half of gyro_bias_time. The "
       "default is 10 deg/h."},
      {"gyro_bias_time", &P::gyro_bias_time, 1.0, large, "s", usual,
       "Twice the time in which the gyro bias walks by gyro_bias_sigma."},
      {"gyro_scale_sigma", &P::gyro_scale_sigma, 0.0, 1.0, "1", usual,
       "Standard deviation of the scale and cross-axis errors of the gyro, which act in turns "
       "only."},
      {"turn_time", &P::turn_time, 0.0, large, "s", expert,
       "Time for which that error stays the same: the duration of a turn."},
      {"acceleration_noise", &P::acceleration_noise, tiny, large, "m/s/sqrt(s)", usual,
       "Velocity random walk of the accelerometers: aliased vibration. With the default, pitch "
       "levels in 10 s."},
      {"accelerometer_turn_on_sigma", &P::accelerometer_turn_on_sigma, tiny, 10.0, "m/s^2", usual,
       "Standard deviation of the accelerometer bias at the start. The default is 0.3 deg of tilt, "
       "of a calibrated unit; `imu_grade` sets it."},
      {"accelerometer_bias_sigma", &P::accelerometer_bias_sigma, tiny, 10.0, "m/s^2", usual,
       "Standard deviation of the random walk of the accelerometer biases over half of "
       "accelerometer_bias_time: warming up, sunshine."},
      {"accelerometer_bias_time", &P::accelerometer_bias_time, 1.0, large, "s", usual,
       "Twice the time in which the accelerometer biases walk by accelerometer_bias_sigma."},
      {"yaw_acceleration", &P::yaw_acceleration, 0.0, 10.0, "rad/s^2", expert,
       "Steering that is not seen between samples and while a sample is held."},
      {"jerk", &P::jerk, 0.0, 100.0, "m/s^3", expert,
       "Braking and accelerating that is not seen between samples and while a sample is held."},
      {"silent_yaw_noise", &P::silent_yaw_noise, tiny, 10.0, "rad/sqrt(s)", expert,
       "Random walk of the azimuth without a gyro."},
      {"silent_speed_noise", &P::silent_speed_noise, tiny, 100.0, "m/s/sqrt(s)", expert,
       "Random walk of the speed without an accelerometer."},
      {"max_specific_force", &P::max_specific_force, 10.0, large, "m/s^2", expert,
       "A larger specific force is refused as a fault of the sensor. The default is 5 g."},
      {"max_yaw_rate", &P::max_yaw_rate, 0.1, large, "rad/s", expert,
       "A larger yaw rate is refused as a fault of the sensor. The default is 350 deg/s."},

      {"pitch_noise", &P::pitch_noise, tiny, 1.0, "rad/sqrt(s)", expert,
       "Random walk of the pitch between two motions of odometry: road and suspension."},
      {"roll_noise", &P::roll_noise, tiny, 1.0, "rad/sqrt(s)", expert,
       "Random walk of the roll: road and suspension."},
      {"rear_axle_distance", &P::rear_axle_distance, -5.0, 5.0, "m", usual,
       "Distance from the rear axle forward to the origin of the body. A recording may know the "
       "value of its car, which holds where this key is absent."},
      {"rear_axle_sigma", &P::rear_axle_sigma, 0.0, 5.0, "m", usual,
       "Standard deviation of rear_axle_distance, which the filter estimates in turns."},
      {"rear_slip", &P::rear_slip, 0.0, 0.1, "rad/(m/s^2)", usual,
       "Slip angle of the rear tyres by lateral acceleration (cornering compliance), which turns a "
       "cornering vehicle's nose into the turn."},
      {"rear_slip_sigma", &P::rear_slip_sigma, 0.0, 0.1, "rad/(m/s^2)", usual,
       "Standard deviation of rear_slip, which the filter estimates in turns."},
      {"slip_sigma", &P::slip_sigma, tiny, 1.0, "rad", expert,
       "Standard deviation of the angle between the direction of travel and the body's axis."},
      {"heave_sigma", &P::heave_sigma, tiny, 1.0, "rad", expert,
       "The same upward: the body pitches and heaves on its springs."},
      {"slip_time", &P::slip_time, 0.0, large, "s", expert, "Correlation time of both."},
      {"climb_offset", &P::climb_offset, -1.0, 1.0, "rad", usual,
       "Angle of the direction of travel above the body's x axis, from the mounting of the "
       "inertial unit. A recording may know the value of its car, which holds where this key is "
       "absent."},
      {"climb_offset_sigma", &P::climb_offset_sigma, tiny, 1.0, "rad", usual,
       "Standard deviation of climb_offset. A recording may know the value of its car, which holds "
       "where this key is absent."},
      {"climb_offset_time", &P::climb_offset_time, 1.0, large, "s", expert,
       "Correlation time of climb_offset: the mounting stays, the load shifts."},
      {"odometry_course_sigma", &P::odometry_course_sigma, tiny, 1.0, "rad", usual,
       "Standard deviation at the start of the angle by which the motions of odometry point to the "
       "right of the vehicle's own, from the mounting of camera and LiDAR."},
      {"odometry_course_walk", &P::odometry_course_walk, 0.0, 1.0, "rad/sqrt(s)", expert,
       "Random walk of that angle."},
      {"imu_delay_sigma", &P::imu_delay_sigma, 0.0, 1.0, "s", usual,
       "Standard deviation at the start of the time by which inertial data is later than its "
       "stamps, against odometry; 0: it is not estimated. Without it here, the delay_sigma of "
       "[vehicle.imu] and [vehicle.camera] say it."},
      {"gnss_delay_sigma", &P::gnss_delay_sigma, 0.0, 1.0, "s", usual,
       "Standard deviation at the start of the time by which the stamps of fixes are late; 0: "
       "it is not estimated. Without it here, the delay_sigma of [vehicle.antenna] says it. The "
       "observations of a receiver have no such delay.",
       late_fixes_choice},
      {"odometry_lever_sigma", &P::odometry_lever_sigma, tiny, 100.0, "m", usual,
       "Standard deviation of the place to the left from which odometry is, the camera's or the "
       "LiDAR's."},
      {"max_tilt", &P::max_tilt, 0.1, 1.5, "rad", expert,
       "A correction to more roll or pitch is refused, because no road vehicle leans so far."},

      {"tilt_rate_noise", &P::tilt_rate_noise, tiny, 1.0, "rad/sqrt(s)", usual,
       "Random walk of pitch and roll where all six axes are used (inertial_axes).",
       six_axes_choice},
      {"levelled_acceleration_noise", &P::levelled_acceleration_noise, tiny, large, "m/s/sqrt(s)",
       usual,
       "The same as acceleration_noise where all six axes are used, because then no road is in it.",
       six_axes_choice},
      {"levelled_tilt_sigma", &P::levelled_tilt_sigma, tiny, 1.0, "rad", expert,
       "The same as tilt_sigma where all six axes are used, because then no suspension is in it.",
       six_axes_choice},
      {"cross_axis_sigma", &P::cross_axis_sigma, 0.0, 1.0, "1", usual,
       "Standard deviation of the share of the yaw rate that the gyros of roll and pitch see.",
       six_axes_choice},
      {"unit_course_sigma", &P::unit_course_sigma, 0.0, 1.0, "rad", usual,
       "Standard deviation of the angle by which a unit of six axes points to the left of the "
       "travel, and ten times that of its change in half of accelerometer_bias_time.",
       six_axes_choice},

      {"tilt_sigma", &P::tilt_sigma, tiny, 1.0, "rad", expert,
       "Standard deviation of the roll seen in one independent accelerometer sample."},
      {"tilt_time", &P::tilt_time, 0.0, large, "s", expert,
       "Correlation time of that error. With the default, roll levels in about 10 s."},
      {"max_acceleration", &P::max_acceleration, 0.0, large, "m/s^2", expert,
       "Forward acceleration above which the accelerometers do not level the vehicle, because it "
       "brakes hard."},
      {"max_lateral_acceleration", &P::max_lateral_acceleration, 0.0, large, "m/s^2", expert,
       "Lateral acceleration above which the accelerometers do not level the vehicle, because it "
       "leans on tyres and springs."},

      {"gnss_correlated", &P::gnss_correlated, 0.0, 0.99, "1", expert,
       "Share of a fix's stated variance that is correlated in time: multipath and atmosphere."},
      {"gnss_offset_time", &P::gnss_offset_time, 0.1, large, "s", expert,
       "Correlation time of that share."},
      {"gnss_position_gate", &P::gnss_position_gate, tiny, large, "1", expert,
       "Gate of a fix's position (chi-square, 3 degrees of freedom); the default has a tail of 0.1 "
       "%."},
      {"gnss_velocity_gate", &P::gnss_velocity_gate, tiny, large, "1", expert,
       "Gate of a fix's velocity (chi-square, 3 degrees of freedom); the default has a tail of 0.1 "
       "%."},
      {"gnss_recover_after", &P::gnss_recover_after, 1, large, "fixes", expert,
       "Fixes gated in a row after which the filter doubts its own position. After twice as many "
       "it starts again at the fix."},
      {"gnss_recover_speed_after", &P::gnss_recover_speed_after, 1, large, "fixes", expert,
       "Velocities gated in a row after which the filter doubts its speed, if they contradict it "
       "by their length alone: wheels slip."},
      {"gnss_recovery_sigma", &P::gnss_recovery_sigma, tiny, large, "m", expert,
       "Standard deviation of the position that the filter then assumes."},
      {"gnss_recovery_course_sigma", &P::gnss_recovery_course_sigma, tiny, 3.0, "rad", expert,
       "Standard deviation of the azimuth that the filter assumes after gnss_recover_after gated "
       "velocities in a row."},
      {"fix_hold", &P::fix_hold, 0.0, large, "s", expert,
       "Time after a fix for which odometry or wheels that contradict the speed are taken to be at "
       "fault, not the prediction."},
      {"doubt_memory", &P::doubt_memory, 0.1, large, "s", expert,
       "Time over which HEALTH looks for lasting contradictions between an aid and the rest."},
      {"doubt_gate", &P::doubt_gate, tiny, large, "1", expert,
       "Mean error of fixes or wheels over that time beyond which HEALTH doubts them "
       "(chi-square, a degree of freedom for each component, if errors were white).",
       doubt_choice},
      {"doubt_motion_gate", &P::doubt_motion_gate, tiny, large, "1", expert,
       "The same of odometry's lengths and turns, beyond which HEALTH doubts the inertial unit.",
       doubt_choice},
      {"doubt_scatter", &P::doubt_scatter, 1.0, large, "1", expert,
       "Mean square of an aid's innovations over that time, relative to their variance, beyond "
       "which HEALTH doubts the aid; fixes then lose weight.",
       doubt_choice},
      {"gnss_lever_forward", &P::gnss_lever_forward, -50.0, 50.0, "m", usual,
       "Position of the antenna from the body's origin, forward."},
      {"gnss_lever_left", &P::gnss_lever_left, -50.0, 50.0, "m", usual,
       "Position of the antenna from the body's origin, to the left."},
      {"gnss_lever_up", &P::gnss_lever_up, -50.0, 50.0, "m", usual,
       "Position of the antenna from the body's origin, upward."},
      {"gnss_lever_sigma", &P::gnss_lever_sigma, 0.0, 50.0, "m", usual,
       "Standard deviation of that position on each axis, which the filter estimates in turns."},

      {"map_position_gate", &P::map_position_gate, tiny, large, "1", expert,
       "Gate of the position across the road (chi-square, 1 degree of freedom); the default has a "
       "tail of 0.1 %."},
      {"map_azimuth_gate", &P::map_azimuth_gate, tiny, large, "1", expert,
       "Gate of the road's azimuth (chi-square, 1 degree of freedom); the default has a tail of 1 "
       "%, since bends and junctions look like outliers."},
      {"map_recover_after", &P::map_recover_after, 1, large, "lines", expert,
       "Road lines gated in a row, over 50 m of way, after which the filter doubts its own "
       "position."},
      {"map_recovery_sigma", &P::map_recovery_sigma, 0.0, large, "m", expert,
       "Standard deviation of the position that the filter then assumes."},
      {"lane_length", &P::lane_length, 1.0, large, "m", expert,
       "Way over which the lane and the error of the map change."},
      {"lane_lasting", &P::lane_lasting, 0.0, 1.0, "1", expert,
       "Share of that error that persists after a turn: the side of the road that is driven on."},

      {"speed_scale_sigma", &P::speed_scale_sigma, tiny, 1.0, "1", expert,
       "Standard deviation of the scale of the speed sensor at the start: of disparities or of "
       "tyres. `configuration` sets it.",
       speed_scale_sigma_choice},
      {"speed_scale_walk", &P::speed_scale_walk, 0.0, 1.0, "1/sqrt(s)", expert,
       "Random walk of that scale, which for odometry changes with the depth of the scene. "
       "`configuration` sets it."},
      {"lidar_scale_sigma", &P::lidar_scale_sigma, 0.0, 1.0, "1", expert,
       "Standard deviation of the LiDAR's range scale, which no number of scans averages out. The "
       "default is 2 cm of range at 10 m, as data sheets state.",
       lidar_scale_sigma_choice},
      {"lidar_turn_sigma", &P::lidar_turn_sigma, 0.0, 1.0, "rad/m", expert,
       "Standard deviation of the LiDAR's drift in azimuth, from an encoder off its axis. The "
       "default is 0.2 deg in 100 m.",
       lidar_turn_sigma_choice},
      {"lidar_error_time", &P::lidar_error_time, 1.0, large, "s", expert,
       "Twice the time in which both errors walk by their standard deviations, since they vary "
       "with the surroundings."},
      {"min_wheel_sigma", &P::min_wheel_sigma, tiny, large, "m/s", expert,
       "Least standard deviation of the speed of the wheels: slip of the tyres on the road."},

      {"still_force", &P::still_force, 0.0, large, "m/s^2", expert,
       "Standard deviation of the forward force over a second below which the vehicle stands "
       "still."},
      {"still_rate", &P::still_rate, 0.0, large, "rad/s", expert,
       "Yaw rate beyond the uncertainty of its bias below which the vehicle stands still."},
      {"still_speed", &P::still_speed, 0.0, large, "m/s", expert,
       "Speed of odometry or wheels below which the vehicle stands still."},
      {"quiet_force", &P::quiet_force, 0.0, large, "m/s^2", expert,
       "Standard deviation of the horizontal specific force over a second, below which the samples "
       "are quiet (still_by_inertia).",
       quiet_choice},
      {"quiet_rate", &P::quiet_rate, 0.0, large, "rad/s", expert, "The same of the yaw rate.",
       quiet_choice},
      {"zero_velocity_sigma", &P::zero_velocity_sigma, tiny, large, "m/s", expert,
       "Standard deviation of zero velocity: the body moves on its springs."},
      {"zero_rate_sigma", &P::zero_rate_sigma, tiny, 1.0, "rad/s", expert,
       "Standard deviation of zero yaw rate, as the mean of a second."},

      {"min_speed_sigma", &P::min_speed_sigma, tiny, large, "m/s", expert,
       "Least standard deviation of the speed of odometry. Stereo odometry reaches 0.03 to 0.1 "
       "m/s."},
      {"min_rotation_sigma", &P::min_rotation_sigma, tiny, 1.0, "rad", expert,
       "Least standard deviation of the rotation of odometry between two frames, which reaches "
       "0.02 to 0.06 deg."},
      {"speed_gate", &P::speed_gate, tiny, large, "1", expert,
       "Gate of the speed (chi-square, 1 degree of freedom); the default has a tail of 0.1 %."},
      {"sideways_gate", &P::sideways_gate, tiny, large, "1", expert,
       "Gate of a motion across and up (chi-square, 2 degrees of freedom), which are left out "
       "where they contradict the prediction; the default has a tail of 0.1 %."},
      {"rotation_gate", &P::rotation_gate, tiny, large, "1", expert,
       "Gate of the rotation (chi-square, 3 degrees of freedom); the default has a tail of 0.1 %."},
      {"chained_azimuth_sigma", &P::chained_azimuth_sigma, tiny, 1.0, "rad", expert,
       "Standard deviation of the chained azimuth at a frame."},
      {"chain_drift", &P::chain_drift, tiny, 1.0, "rad/sqrt(m)", expert,
       "Drift of the chained azimuth beyond the covariance of odometry."},
      {"recover_after", &P::recover_after, 1, large, "motions", expert,
       "Motions gated in a row, over 1 s, after which the filter doubts its own state."},
      {"recovery_speed_sigma", &P::recovery_speed_sigma, tiny, large, "m/s", expert,
       "Standard deviation of the speed that the filter then assumes."},
      {"recovery_rotation_sigma", &P::recovery_rotation_sigma, tiny, 1.0, "rad", expert,
       "Standard deviation of the rotation over one interval that the filter then assumes."},
  });
  const auto rules = [](const P& p) -> std::optional<ParameterProblem> {
    if (p.confirm_gap > p.history_length)
      return {{"confirm_gap", "must be at most history_length"}};
    if (p.max_gap < p.confirm_gap) return {{"max_gap", "must be at least confirm_gap"}};
    if (p.max_stamp_ahead > p.confirm_gap)
      return {{"max_stamp_ahead", "must be at most confirm_gap"}};
    if (p.imu_hold > p.history_length) return {{"imu_hold", "must be at most history_length"}};
    if (p.imu_bridge < p.imu_hold || p.imu_bridge > p.history_length)
      return {{"imu_bridge", "must be from imu_hold to history_length"}};
    if (p.max_interval > p.max_gap) return {{"max_interval", "must be at most max_gap"}};
    return std::nullopt;
  };
  return {
      "fusion",
      "The reduced-IMU filter. Its values come from the physics of a road vehicle and its sensors.",
      table, rules};
}

}  // namespace maploop::fusion
