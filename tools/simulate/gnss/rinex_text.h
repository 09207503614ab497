// Formats lines of RINEX and related formats.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "ppp/gps_time.h"

namespace maploop::simulate {

// The type that observations and calibrations state.
inline constexpr const char* antenna_type = "SIMULATED ROOF  NONE";

// Pads the content to 60 columns and appends the label.
inline std::string header_line(std::string content, std::string_view label) {
  content.resize(60, ' ');
  return content.append(label) + '\n';
}

// Returns "2026 05 04 08 00" and the seconds in the given format.
inline std::string stamp_text(ppp::GpsTime t, fmt::string_view seconds_format) {
  const ppp::CalendarTime c = ppp::calendar(t);
  return fmt::format("{:4} {:02} {:02} {:02} {:02}", c.year, c.month, c.day, c.hour, c.minute) +
         fmt::vformat(seconds_format, fmt::make_format_args(c.second));
}

}  // namespace maploop::simulate
