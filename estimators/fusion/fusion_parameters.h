// Parameters of the reduced-IMU filter, chosen from the physics of a road vehicle and its sensors.
#pragma once

namespace maploop::fusion {

struct FusionParameters {
  // Which measurements correct the state; configurations by name set these (configuration.h).
  bool use_gnss = false;                // after the start, which always takes a fix
  bool use_odometry_speed = true;       // visual or visual-LiDAR odometry's forward speed
  bool use_odometry_azimuth = true;     // and its turning, as the increment over each interval
  bool chain_odometry_azimuth = false;  // or added up to an azimuth of its own, as in the thesis
  bool use_wheel_speed = false;
  bool use_zero_velocity = true;  // where the detector sees the vehicle stand

  // History and time.
  double history_length = 3.0;    // s, late data is applied within it; odometry is < 0.3 s late
  int history_capacity = 512;     // events; 3 s of 100 Hz IMU and 10 Hz odometry take about 360
  double confirm_gap = 1.0;       // s, a stamp further ahead needs a second one that agrees
  double max_gap = 5.0;           // s, beyond it nothing is predicted: the clock jumped
  double max_stamp_ahead = 0.05;  // s, of its delivery: clocks of sensor and host agree better
  int restart_after = 100;      // refusals in a row for their stamps; then the clock really jumped
  double max_step = 0.05;       // s, a chord of a 30 deg/s turn is 3e-5 shorter than its arc
  double imu_hold = 0.3;        // s, three missing samples of a 10 Hz IMU; then it is silent
  double repeat_speed = 2.0;    // m/s, from there on no unit repeats its values for imu_hold
  double imu_bridge = 2.0;      // s, a longer gap between two samples may hide a whole turn
  double coasting_after = 1.0;  // s without odometry until the state calls itself coasting
  double max_interval = 1.0;    // s, longest odometry interval; speed is not constant for longer
  double max_origin_distance = 50e3;  // m, the plumb line is linear in position up to there

  // Start, from one GNSS fix.
  double min_course_speed = 2.0;       // m/s, 0.1 m/s of velocity noise is 3 deg of course there
  double max_stamp_offset = 0.2;       // s between a fix's position and its velocity
  double min_position_sigma = 0.1;     // m, floor; no receiver of a road vehicle is better
  double min_velocity_sigma = 0.03;    // m/s, floor
  double start_course_sigma = 0.0087;  // rad (0.5 deg), course against body: side slip, mounting
  double start_slope_sigma = 0.0087;   // rad (0.5 deg), climb against pitch: suspension
  double start_roll_sigma = 0.035;     // rad (2 deg), cross fall of a road and suspension
  double start_acceleration = 3.0;     // m/s^2, change of speed between a fix's two stamps

  // Inertial sensors.
  double gyro_noise = 8.7e-5;           // rad/sqrt(s) (0.3 deg/sqrt(h)), MEMS angle random walk
  double gyro_turn_on_sigma = 1.75e-4;  // rad/s (36 deg/h), its bias at the start
  double gyro_bias_sigma = 4.8e-5;      // rad/s (10 deg/h), how far the bias walks ...
  double gyro_bias_time = 300.0;        // s, ... in half of this time
  double gyro_scale_sigma = 0.003;      // 1, scale and cross-axis error; acts in turns only
  double turn_time = 3.0;               // s, how long a turn keeps that error
  double acceleration_noise = 0.3;      // m/s/sqrt(s), aliased vibration; levels pitch in 10 s
  double accelerometer_turn_on_sigma = 0.05;  // m/s^2 (0.3 deg of tilt), at the start, calibrated
  double accelerometer_bias_sigma = 0.01;     // m/s^2, how far they walk (warming, sun) ...
  double accelerometer_bias_time = 300.0;     // s, ... in half of this time
  double yaw_acceleration = 0.3;     // rad/s^2, steering unseen between samples and while held
  double jerk = 2.0;                 // m/s^3, pedals unseen between samples and while held
  double silent_yaw_noise = 0.3;     // rad/sqrt(s), azimuth without a gyro
  double silent_speed_noise = 2.0;   // m/s/sqrt(s), speed without an accelerometer
  double max_specific_force = 50.0;  // m/s^2, beyond is a fault of the sensor (5 g)
  double max_yaw_rate = 6.0;         // rad/s, beyond is a fault (350 deg/s)

  // Vehicle.
  double pitch_noise = 0.0175;         // rad/sqrt(s) (1 deg), road and suspension between odometry
  double roll_noise = 0.0175;          // rad/sqrt(s) (1 deg)
  double rear_axle_distance = 0.0;     // m, from the rear axle forward to the body's origin
  double slip_sigma = 0.005;           // rad (0.3 deg), direction of travel against the body's axis
  double slip_time = 1.0;              // s, how long it lasts
  double climb_offset = 0.0;           // rad, direction of travel above body x: mounting of the IMU
  double climb_offset_sigma = 0.0175;  // rad (1 deg), of that
  double climb_offset_time = 300.0;    // s, its correlation time: mounting stays, load shifts
  double climb_noise = 0.02;           // rad (1.1 deg) a frame, heave and vertical odometry error
  double max_tilt = 0.8;  // rad, no road vehicle leans so; a correction beyond is refused

  // Levelling by the accelerometers.
  double tilt_sigma = 0.0175;     // rad (1 deg), of the roll seen in one independent sample
  double tilt_time = 3.0;         // s, how long its disturbance lasts; levels roll in about 10 s
  double max_acceleration = 3.0;  // m/s^2 along, larger: braking hard, no levelling
  double max_lateral_acceleration = 4.0;  // m/s^2 across, larger: tyres and springs lean

  // GNSS. Its stated variance is split: errors of multipath and atmosphere last.
  double gnss_correlated = 0.7;       // 1, share of a position's variance that lasts ...
  double gnss_offset_time = 30.0;     // s, ... this long
  double gnss_position_gate = 16.27;  // chi-square, 3 degrees of freedom, 0.1 % tail
  double gnss_velocity_gate = 16.27;
  int gnss_recover_after = 5;         // gated in a row; then doubts itself, and after twice as many
                                      // begins anew at the fix
  double gnss_recovery_sigma = 20.0;  // m, how wrong its position may then be
  double fix_hold = 3.0;              // s behind a fix in which odometry or wheels that contradict
                                      // the speed are at fault, not the prediction
  double gnss_lever_forward = 0.0;    // m, antenna from the body's origin
  double gnss_lever_left = 0.0;
  double gnss_lever_up = 0.0;

  // Map feedback. Lane and map error stay along a road, and differ from road to road.
  double map_position_gate = 10.83;  // chi-square, 1 degree of freedom, 0.1 % tail
  double map_azimuth_gate = 6.63;    // the same, 1 %: bends and junctions look like that
  int map_recover_after = 5;         // lines gated in a row (50 m of way); then doubts itself
  double map_recovery_sigma = 10.0;  // m, how wrong its position may then be
  double lane_length = 300.0;        // m of way in which a lane and the map's error change
  double lane_lasting = 0.3;  // 1, share of them that goes on behind a turn: the side driven on

  // Scale of the speed sensor: tyres, or disparities that are a little too large or too small.
  double speed_scale_sigma = 0.015;  // 1, at the start: 1.2 % rms in odometry of six drives
  double speed_scale_walk = 0.001;   // 1/sqrt(s), odometry's changes with the depth of the scene

  // What lasts of a LiDAR's errors, whatever number of scans: ranges that are all too long or too
  // short, azimuths of an encoder off its axis.
  double lidar_scale_sigma = 0.002;  // 1, 2 cm of range, as data sheets have it, at 10 m
  double lidar_turn_sigma = 3.5e-5;  // rad/m (0.2 deg in 100 m)
  double lidar_error_time = 300.0;   // s, they walk as far in half of it, with what is around

  // Wheels.
  double min_wheel_sigma = 0.02;  // m/s, floor: slip of the tyres on the road

  // Standing still.
  double still_force = 0.05;          // m/s^2, deviation of the forward force over a second
  double still_rate = 0.0052;         // rad/s (0.3 deg/s), beyond what the bias may be
  double still_speed = 0.1;           // m/s, that odometry or wheels may show
  double zero_velocity_sigma = 0.02;  // m/s, body on its springs
  double zero_rate_sigma = 1.7e-4;    // rad/s (0.01 deg/s), a second's mean

  // Odometry. Its own covariance counts, but not its correlated part: hence floors and a scale.
  double min_speed_sigma = 0.05;          // m/s, floor; stereo odometry reaches 0.03 to 0.1
  double min_rotation_sigma = 5.2e-4;     // rad (0.03 deg) a frame, floor; it reaches 0.02 to 0.06
  double speed_gate = 10.83;              // chi-square, 1 degree of freedom, 0.1 % tail
  double rotation_gate = 16.27;           // chi-square, 3 degrees of freedom, 0.1 % tail
  double chained_azimuth_sigma = 0.0035;  // rad (0.2 deg), of the chained azimuth at a frame
  double chain_drift = 8.7e-5;            // rad/sqrt(m) (0.005 deg), beyond odometry's covariance
  int recover_after = 10;             // gated in a row (1 s); then the filter is the one at fault
  double recovery_speed_sigma = 5.0;  // m/s, how wrong its speed may then be
  double recovery_rotation_sigma = 0.05;  // rad (3 deg), and its rotation over one interval
};

// Throws std::invalid_argument naming the first parameter that cannot work, and its bounds.
void check(const FusionParameters& parameters);

}  // namespace maploop::fusion
