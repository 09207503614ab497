// Formats lines of RINEX and related formats.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "ppp/gps_time.h"

namespace maploop::simulate {

// Pads the content to 60 columns and appends the label.
inline std::string header_line(std::string content, std::string_view label) {
  content.resize(60, ' ');
  return content.append(label) + '\n';
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[256];
  const int length = std::snprintf(text, sizeof text, format, values...);
  return {text, static_cast<std::size_t>(length)};
}

// Returns "2026 05 04 08 00" and the seconds in the given format.
inline std::string stamp_text(ppp::GpsTime t, const char* seconds_format) {
  const ppp::CalendarTime c = ppp::calendar(t);
  return formatted("%4d %02d %02d %02d %02d", c.year, c.month, c.day, c.hour, c.minute) +
         formatted(seconds_format, c.second);
}

}  // namespace maploop::simulate
