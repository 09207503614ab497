#include "sensors/replay/parameter_table.h"

namespace maploop::sensors {

namespace {
constexpr Audience usual = Audience::usual;
}

ParameterTable<KittiDriveParameters> parameter_table(const KittiDriveParameters&) {
  using P = KittiDriveParameters;
  constexpr double hour =
      3600.0;  // nothing is longer, and the arithmetic of stamps stays far from its limits
  constexpr DataChoice imu_delay_choice{"KITTI odometry sequences, all eight",
                                        "measured without a position's truth, 53 to 67 ms",
                                        "fusion on KITTI"};
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"imu_delay", &P::imu_delay, 0.0, hour, "s",
       "Time by which OXTS rates, velocities and accelerations are older than the stamp of their "
       "row.",
       usual, imu_delay_choice},
      {"camera_readout", &P::camera_readout, 0.0, hour, "s",
       "Time from the later exposure of a pair to its delivery."},
      {"max_pair_skew", &P::max_pair_skew, 0.0, hour, "s",
       "Largest difference between the stamps of the left and the right image. 3.5 ms is the "
       "largest one of the recordings."},
      {"max_turn", &P::max_turn, 0.0, hour, "s",
       "Longest duration of a scan. The slowest turn of an HDL-64E takes 0.2 s."},
  });
  return {"replay", "Recorded drives.", table};
}

ParameterTable<PoseOdometryParameters> parameter_table(const PoseOdometryParameters&) {
  using P = PoseOdometryParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"file", &P::file,
       "Poses of the left camera in KITTI's format; the path starts from this file's folder. "
       "Empty: none.",
       usual},
      {"speed_sigma", &P::speed_sigma, above_zero, 1e6, "m/s",
       "Standard deviation of the speed of a motion, because the trajectory does not state one.",
       usual},
      {"rotation_sigma", &P::rotation_sigma, above_zero, 180.0, "deg",
       "Standard deviation per axis of the rotation of a motion.", usual},
  });
  return {"odometry_poses",
          "The trajectory of another system in place of visual odometry, for a sequence of KITTI's "
          "odometry benchmark.",
          table};
}

ParameterTable<GnssAidParameters> parameter_table(const GnssAidParameters&) {
  using P = GnssAidParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"rate", &P::rate, 1e-3, 1e3, "Hz", "Fixes per second.", usual},
      {"white_position", &P::white_position, 0.0, 1e6, "m",
       "Standard deviation per axis of the position error that is independent from fix to fix.",
       usual},
      {"markov_position", &P::markov_position, 0.0, 1e6, "m",
       "Standard deviation per axis of the first-order Gauss-Markov position error: multipath and "
       "atmosphere, which do not average out within a turn.",
       usual},
      {"markov_time", &P::markov_time, 1e-3, 1e6, "s", "Correlation time of that error.", usual},
      {"white_velocity", &P::white_velocity, 0.0, 1e6, "m/s",
       "Standard deviation per axis of the velocity error (Doppler).", usual},
      {"errors", one_of<&P::errors>,
       "\"drawn\": the seed draws the sizes of the errors, and adds steps "
       "(sensors/replay/gnss_aid.h). The fixes and the filter go on stating the given ones.",
       usual},
      {"seed", &P::seed, -2147483648.0, 2147483647.0, "1",
       "Another seed gives another realization.", usual},
  });
  return {"gnss", "Fixes of a GNSS receiver, made from the recorded position.", table};
}

ParameterTable<WheelOdometerParameters> parameter_table(const WheelOdometerParameters&) {
  using P = WheelOdometerParameters;
  static constexpr auto table = std::to_array<Parameter<P>>({
      {"scale_error", &P::scale_error, -0.5, 0.5, "1",
       "Share by which the speed is read too large. Worn or soft tyres cause 1 %.", usual},
      {"white_speed", &P::white_speed, 0.0, 1e6, "m/s",
       "Standard deviation of the speed, independent from sample to sample: counted pulses.",
       usual},
      {"slip", &P::slip, 0.0, 0.1, "s^2/m",
       "Share of the speed by which the wheels turn too fast for each m/s^2 of the force that "
       "drives the car, and too slowly where it brakes.",
       usual},
      {"ice_share", &P::ice_share, 0.0, 1.0, "1",
       "Share of the road, in squares of 50 m, where the wheels slip ten times as much.", usual},
      {"errors", one_of<&P::errors>,
       "\"drawn\": the seed draws scale_error, slip and ice_share "
       "(sensors/replay/wheel_odometer.h).",
       usual},
      {"seed", &P::seed, -2147483648.0, 2147483647.0, "1",
       "Another seed gives another realization.", usual},
  });
  return {"wheel", "A wheel odometer, made from the recorded speed.", table};
}

}  // namespace maploop::sensors
