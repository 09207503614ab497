#include "tools/ppp/chosen_times.h"

#include <chrono>
#include <stdexcept>

#include "msgs/time.h"
#include "tools/evaluate/text_lines.h"

namespace maploop::gnss {

using namespace maploop::ppp;

namespace {

GpsTime moment(const std::string& text, const std::string& option, GpsTime first) {
  if (const auto seconds = evaluation::number_of<double>(text))
    return first + from_seconds(*seconds);
  const std::string whole =
      text.find('-') == std::string::npos ? format_gps_time(first).substr(0, 11) + text : text;
  try {
    // GPS time's calendar has no leap seconds, as the parser's.
    return GpsTime(parse_time(whole) - Time(gps_epoch_day));
  } catch (const std::invalid_argument&) {
    throw std::runtime_error(
        option + ": '" + text +
        "' is neither YYYY-MM-DD HH:MM:SS nor HH:MM:SS of GPS time, nor seconds "
        "since the first epoch");
  }
}

bool is_time_of_day(const std::string& text) {
  return text.find(':') != std::string::npos && text.find('-') == std::string::npos;
}

}  // namespace

GpsTime beginning(const std::string& text, const std::string& option, GpsTime first, GpsTime last) {
  constexpr std::chrono::hours day(24);
  const GpsTime t = moment(text, option, first);
  return is_time_of_day(text) && t < first && t + day <= last ? t + day : t;
}

GpsTime ending(const std::string& text, const std::string& option, GpsTime first, GpsTime start,
               GpsTime last) {
  using Days = std::chrono::days;
  const GpsTime t = moment(text, option, first);
  const bool next_day = std::chrono::floor<Days>(last) > std::chrono::floor<Days>(t);
  return is_time_of_day(text) && t < start && next_day ? t + Days(1) : t;
}

}  // namespace maploop::gnss
