// These are the data on which values of [fusion] and [guard] were chosen.
#pragma once

#include "msgs/parameter.h"

namespace maploop::fusion {

inline constexpr DataChoice repeat_speed_choice{
    "three drives of the car in Oakville",
    "longest repetition of its inertial samples, rounded to coarse steps, by speed",
    "none is published"};
inline constexpr DataChoice speed_scale_sigma_choice{"visual odometry of six KITTI drives",
                                                     "1.2 % rms against the truth's length",
                                                     "fusion on KITTI with `VO`"};
inline constexpr DataChoice lidar_scale_sigma_choice{
    "KITTI drive 0013", "the data sheet's 2 cm at 10 m; the drive shows as much (0.19 %)",
    "normalized errors of the vehicle on 0013"};
inline constexpr DataChoice lidar_turn_sigma_choice{
    "KITTI drive 0013", "what the scans' yaw drifts by there, 0.2 deg in 100 m",
    "normalized errors and azimuth of the vehicle on 0013"};
inline constexpr DataChoice quiet_choice{
    "five drives of the car in Oakville (1, 3, 5, 7, 9)",
    "what a standing car stays below in most seconds, and a moving one never",
    "none; outages are scored on the other five"};
inline constexpr DataChoice six_axes_choice{
    "five drives of the car in Oakville (1, 3, 5, 7, 9)",
    "outages of 10, 30 and 60 s, whose median error changes by a third within a factor of two",
    "none; outages are scored on the other five"};
inline constexpr DataChoice late_fixes_choice{
    "five drives of the car in Oakville (1, 3, 5, 7, 9)",
    "position with stamps of fixes that are right, 0.2 and 0.4 s late; 0.03 to 0.1 s differ little",
    "none; stamps are scored on the other five"};
inline constexpr DataChoice doubt_choice{
    "simulated towns 1 to 3, KITTI 00, 02, 03, 04 and five drives of the car in Oakville",
    "above what sensors without a fault reach, but for one parking lot",
    "none; the fault matrix is scored on town 13 and drive 0013"};
inline constexpr DataChoice course_velocity_choice{
    "simulated drives between houses 4, 10, 12, 16, 18, 20",
    "above what their first right velocities have, below those that are wrong by 5 to 15 m/s",
    "between houses, drives 11 to 20"};
inline constexpr DataChoice overconfidence_choice{
    "KITTI odometry sequences, 60 s without GNSS", "mean NEES of 2.9 to 4 where 2 is expected",
    "the map in the loop, also on wrong maps, on KITTI"};

}  // namespace maploop::fusion
