#include "sensors/replay/parameter_table.h"

namespace maploop::sensors {

ParameterTable<KittiDriveParameters> parameter_table(const KittiDriveParameters&) {
  using enum Audience;
  using P = KittiDriveParameters;
  // Nothing here is longer, and the arithmetic of stamps stays far from its limits.
  constexpr double hour = 3600.0;  // s
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"camera_readout", &P::camera_readout, 0.0, hour, "s", expert,
       "Time from the later exposure of a pair to its delivery."},
      {"max_pair_skew", &P::max_pair_skew, 0.0, hour, "s", expert,
       "Largest difference between the stamps of the left and the right image. 3.5 ms is the "
       "largest one of the recordings."},
      {"max_turn", &P::max_turn, 0.0, hour, "s", expert,
       "Longest duration of a scan. The slowest turn of an HDL-64E takes 0.2 s."},
  });
  constexpr auto rules = [](const P& p) -> std::optional<ParameterProblem> {
    if (p.imu_delay >= 0.0 && p.imu_delay <= hour) return std::nullopt;
    return ParameterProblem{"imu_delay", "is not a delay of 0 to 3600 s"};
  };
  return {"replay", "Recorded drives.", table, rules};
}

ParameterTable<PoseOdometryParameters> parameter_table(const PoseOdometryParameters&) {
  using enum Audience;
  using P = PoseOdometryParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"file", &P::file, usual,
       "Poses of the left camera in KITTI's format; the path starts from this file's folder. "
       "Empty: none."},
      {"speed_sigma", &P::speed_sigma, above_zero, 1e6, "m/s", usual,
       "Standard deviation of the speed of a motion, because the trajectory does not state one."},
      {"rotation_sigma", &P::rotation_sigma, above_zero, 180.0, "deg", usual,
       "Standard deviation per axis of the rotation of a motion."},
  });
  return {"odometry_poses",
          "The trajectory of another system in place of visual odometry, for a sequence of KITTI's "
          "odometry benchmark.",
          table};
}

ParameterTable<GnssAidParameters> parameter_table(const GnssAidParameters&) {
  using enum Audience;
  using P = GnssAidParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"rate", &P::rate, 1e-3, 1e3, "Hz", usual, "Fixes per second."},
      {"white_position", &P::white_position, 0.0, 1e6, "m", usual,
       "Standard deviation per axis of the position error that is independent from fix to fix."},
      {"markov_position", &P::markov_position, 0.0, 1e6, "m", usual,
       "Standard deviation per axis of the first-order Gauss-Markov position error: multipath and "
       "atmosphere, which do not average out within a turn."},
      {"markov_time", &P::markov_time, 1e-3, 1e6, "s", usual, "Correlation time of that error."},
      {"white_velocity", &P::white_velocity, 0.0, 1e6, "m/s", usual,
       "Standard deviation per axis of the velocity error (Doppler)."},
      {"errors", one_of<&P::errors>, usual,
       "\"drawn\": the seed draws the sizes of the errors, and adds steps "
       "(sensors/replay/gnss_aid.h). The fixes and the filter go on stating the given ones."},
      {"seed", &P::seed, -2147483648.0, 2147483647.0, "1", usual,
       "Another seed gives another realization."},
  });
  return {"gnss", "Fixes of a GNSS receiver, made from the recorded position.", table};
}

ParameterTable<WheelOdometerParameters> parameter_table(const WheelOdometerParameters&) {
  using enum Audience;
  using P = WheelOdometerParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"scale_error", &P::scale_error, -0.5, 0.5, "1", usual,
       "Share by which the speed is read too large. Worn or soft tyres cause 1 %."},
      {"white_speed", &P::white_speed, 0.0, 1e6, "m/s", usual,
       "Standard deviation of the speed, independent from sample to sample: counted pulses."},
      {"slip", &P::slip, 0.0, 0.1, "s^2/m", usual,
       "Share of the speed by which the wheels turn too fast for each m/s^2 of the force that "
       "drives the car, and too slowly where it brakes."},
      {"ice_share", &P::ice_share, 0.0, 1.0, "1", usual,
       "Share of the road, in squares of 50 m, where the wheels slip ten times as much."},
      {"errors", one_of<&P::errors>, usual,
       "\"drawn\": the seed draws scale_error, slip and ice_share "
       "(sensors/replay/wheel_odometer.h)."},
      {"seed", &P::seed, -2147483648.0, 2147483647.0, "1", usual,
       "Another seed gives another realization."},
  });
  return {"wheel", "A wheel odometer, made from the recorded speed.", table};
}

}  // namespace maploop::sensors
