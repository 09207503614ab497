// This table states what may be written about each kind of fault. The parser, the help and the page
// FAULTS.md are made from it.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "runtime/vehicle/faults/fault.h"

namespace maploop::vehicle {

// A kind has one rule for each set of targets that share its default. The key `by` exists where
// largest_by is above 0.
struct FaultRule {
  FaultKind kind;
  std::string_view name;
  std::span<const FaultTarget> targets;
  std::string_view what;
  std::string_view unit = {};  // of `by`
  double default_by = 0.0;
  double largest_by = 0.0;
  bool signed_by = false;
};

constexpr double longest_drive = 1e6;  // s; far below the range of int64 nanoseconds

namespace fault_rules {
using enum FaultTarget;
inline constexpr std::array all_sensors{camera, velodyne, imu, gnss, wheel};
inline constexpr std::array numeric_sensors{velodyne, imu, gnss, wheel};
inline constexpr std::array relative_sensors{gyro, accelerometer, wheel};
inline constexpr std::array mounted_sensors{camera, velodyne};
inline constexpr std::array only_camera{camera};
inline constexpr std::array only_velodyne{velodyne};
inline constexpr std::array only_gyro{gyro};
inline constexpr std::array only_accelerometer{accelerometer};
inline constexpr std::array only_gnss{gnss};
inline constexpr std::array stages{stereo, lidar, ppp, fusion, mapmatch};
inline constexpr std::array machine{cpu};

// The first rule of each kind is in the order of FaultKind.
using enum FaultKind;
inline constexpr std::array<FaultRule, 30> all{{
    {late, "late", all_sensors, "a sample arrives `by` later; none overtakes it", "s", 0.2, 10.0},
    {lost, "lost", all_sensors, "a sample never arrives"},
    {duplicated, "duplicated", all_sensors, "a sample arrives again, `by` later", "s", 0.001, 1.0},
    {reordered, "reordered", all_sensors, "a sample arrives after its successor"},
    {jump, "jump", all_sensors, "the stamps are wrong by `by`; the arrival is unchanged", "s", 1.0,
     longest_drive, true},
    {nan, "nan", numeric_sensors, "every number of a sample is NaN"},
    {frozen, "frozen", all_sensors, "a sample's content is that of the first one struck"},
    {black, "black", only_camera, "both images are black"},
    {garbage, "garbage", only_camera, "both images are noise"},
    {bias, "bias", only_gyro, "each rate is too large by `by`", "deg/s", 0.5, 100.0, true},
    {bias, "bias", only_accelerometer, "each force is too large by `by`", "m/s^2", 0.5, 50.0, true},
    {bias, "bias", only_gnss, "positions lie `by` too far to the east", "m", 10.0, 1e6, true},
    {drift, "drift", only_gyro, "a bias that grows by `by` a second", "deg/s^2", 0.05, 100.0, true},
    {drift, "drift", only_accelerometer, "a bias that grows by `by` a second", "m/s^3", 0.05, 50.0,
     true},
    {drift, "drift", only_gnss, "positions drift to the east; the velocities stay right", "m/s",
     0.5, 1e3, true},
    {scale, "scale", relative_sensors, "values are too large by this share", "1", 0.05, 10.0, true},
    {noise, "noise", only_gyro, "white noise of this standard deviation", "deg/s", 1.0, 100.0},
    {noise, "noise", only_accelerometer, "the same", "m/s^2", 1.0, 50.0},
    {noise, "noise", only_gnss,
     "the same on each axis of the position (observations: on the codes)", "m", 10.0, 1e6},
    {noise, "noise", only_velodyne, "the same on the ranges", "m", 0.2, 100.0},
    {spoofed, "spoofed", only_gnss, "positions are pulled away to the east, velocities agree",
     "m/s", 0.5, 1e3, true},
    {bumped, "bumped", mounted_sensors, "the sensor has been turned to the left", "deg", 1.0, 45.0,
     true},
    {skewed, "skewed", all_sensors, "the stamps run away at this rate", "ppm", 200.0, 1e5, true},
    {blurred, "blurred", only_camera, "each pixel is the mean of all within `by`", "px", 4.0, 50.0},
    {dimmed, "dimmed", only_camera, "this share of the light is lost", "1", 0.9, 1.0},
    {blocked, "blocked", only_velodyne, "this sector ahead gives no returns", "deg", 120.0, 360.0},
    {rain, "rain", only_velodyne,
     "this share of the returns is of drops within 6 m, the same share of those beyond 20 m is "
     "lost",
     "1", 0.3, 1.0},
    {slow, "slow", stages, "the stage sleeps `by` at each image, scan, ...", "s", 0.1, 1.0},
    {broken, "broken", stages, "the stage ends with an error"},
    {hog, "hog", machine, "`threads` threads are busy for LENGTH (required)"},
}};
}  // namespace fault_rules

// "late, lost, ...": the names of all kinds.
std::string fault_kinds();

// The table as the Markdown page FAULTS.md.
std::string fault_page();

}  // namespace maploop::vehicle
