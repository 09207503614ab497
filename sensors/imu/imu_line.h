// One inertial sample as a line of text: for units that maploop does not know, through a program of
// a few lines beside them.
//
//   $PIMU,12.345678,0.0123,-0.0456,0.000789*hh
//
// a sentence as NMEA 0183 has them, with its checksum: time of the measurement on the unit's own
// clock (s, from anywhere, increasing), specific force forward and left (m/s^2), yaw rate, positive
// to the left (rad/s).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "msgs/time.h"

namespace maploop::sensors {

struct ImuLine {
  Duration time{};  // of the unit's clock
  double specific_force_forward = 0.0;
  double specific_force_left = 0.0;
  double yaw_rate = 0.0;
};

// Nothing where it is no such line, its checksum is wrong, or a value cannot be of a vehicle
// (500 m/s^2, 100 rad/s, 30 years).
std::optional<ImuLine> parse_imu_line(std::string_view line);

// With its end.
std::string imu_line(const ImuLine& sample);

}  // namespace maploop::sensors
