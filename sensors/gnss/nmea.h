// This file parses NMEA 0183 sentences.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "msgs/time.h"

namespace maploop::sensors {

// The members are views into the line that was parsed.
struct NmeaSentence {
  static constexpr std::size_t max_fields = 40;  // GSV, the longest, has 21

  std::string_view talker;  // "GP", "GN"; empty for a proprietary sentence
  std::string_view kind;    // "RMC"; the whole name of a proprietary sentence
  std::array<std::string_view, max_fields> fields{};  // the fields after the name
  std::size_t count = 0;

  // Returns an empty view if the field does not exist.
  std::string_view field(std::size_t i) const { return i < count ? fields[i] : std::string_view(); }
  std::optional<double> number(std::size_t i) const;  // finite
};

// Parses a line with or without its line end. Returns nothing if it is not a sentence, has no
// checksum or a wrong one, or has more than max_fields fields.
std::optional<NmeaSentence> parse_nmea(std::string_view line);

// Parses "hhmmss[.fff]" as time since midnight; a leap second is the midnight after it.
std::optional<Duration> nmea_time_of_day(std::string_view text);

// Parses "ddmmyy" of the years 1980 to 2079 as UTC midnight.
std::optional<Time> nmea_date(std::string_view text);

// Parses "ddmm.mmmm" or "dddmm.mmmm" with its hemisphere; rad, north and east positive.
std::optional<double> nmea_angle(std::string_view digits, std::string_view hemisphere);

// "$<body>*<checksum>\r\n".
std::string nmea_sentence(const std::string& body);

// An angle in rad as "ddmm.mmmmmmm,N", with two or three digits of degrees; `hemispheres` are those
// of a positive and of a negative angle, such as "NS".
std::string nmea_angle_fields(double angle, int degree_digits, const char* hemispheres);

}  // namespace maploop::sensors
