// This file defines one inertial sample as a line of text, for units that maploop does not support
// itself: a program of a few lines converts their data.
//
//   $PIMU,12.345678,0.0123,-0.0456,0.000789*hh
//   $PIMU,12.345678,0.0123,-0.0456,0.000789,9.8067,0.00123,-0.00456*hh
//
// The line is a sentence in the form of NMEA 0183 with its checksum: time of the measurement on the
// unit's own clock (s, any origin, increasing), specific force forward and left (m/s^2), yaw rate,
// positive to the left (rad/s). A unit of six axes adds the specific force up, and the rates about
// the forward axis, right side down, and about the left one, nose down.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "msgs/imu.h"
#include "msgs/time.h"

namespace maploop::sensors {

struct ImuLine {
  Duration time{};  // of the unit's clock
  InertialValues values;
};

// Returns nothing if the line is not such a sentence, its checksum is wrong, or a value is out of
// range for a vehicle (500 m/s^2, 100 rad/s, 30 years).
std::optional<ImuLine> parse_imu_line(std::string_view line);

// Returns the line with its line end.
std::string imu_line(const ImuLine& sample);

}  // namespace maploop::sensors
