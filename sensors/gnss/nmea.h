// NMEA 0183 sentences.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "msgs/time.h"

namespace maploop::sensors {

// Views into the line it was parsed from.
struct NmeaSentence {
  static constexpr std::size_t max_fields = 40;  // GSV, the longest, has 21

  std::string_view talker;  // "GP", "GN"; empty of a proprietary sentence
  std::string_view kind;    // "RMC"; of a proprietary sentence all of its name
  std::array<std::string_view, max_fields> fields{};  // after the name
  std::size_t count = 0;

  // Empty where there is none.
  std::string_view field(std::size_t i) const { return i < count ? fields[i] : std::string_view(); }
  std::optional<double> number(std::size_t i) const;  // finite
};

// `line` with or without its end. Nothing where it is no sentence, has no checksum or a wrong one,
// or more fields than any sentence has.
std::optional<NmeaSentence> parse_nmea(std::string_view line);

// "hhmmss[.fff]" as time since midnight; a leap second is the midnight after it.
std::optional<Duration> nmea_time_of_day(std::string_view text);

// "ddmmyy", of the years 1980 to 2079.
std::optional<Time> nmea_date(std::string_view text);

// "ddmm.mmmm" or "dddmm.mmmm" and its hemisphere, rad.
std::optional<double> nmea_angle(std::string_view digits, std::string_view hemisphere);

}  // namespace maploop::sensors
