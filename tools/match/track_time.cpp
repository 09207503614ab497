#include "tools/match/track_time.h"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

namespace maploop::match {

std::optional<Time> parse_track_time(std::string_view text) {
  double seconds = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, seconds);
  if (error == std::errc() && stop == end) {
    if (!std::isfinite(seconds) || std::abs(seconds) > 9e9) return {};
    return Time(from_seconds(seconds));
  }
  std::string date(text);
  if (const auto t = date.find('T'); t != std::string::npos) date[t] = ' ';
  if (date.ends_with('Z')) date.pop_back();
  if (date.ends_with("+00:00")) date.resize(date.size() - 6);
  try {
    return parse_time(date);
  } catch (const std::invalid_argument&) {
    return {};
  }
}

}  // namespace maploop::match
