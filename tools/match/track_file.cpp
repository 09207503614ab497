#include "tools/match/track_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <string>

#include "msgs/input_limits.h"
#include "tools/evaluate/log_messages.h"
#include "tools/evaluate/text_file.h"
#include "tools/evaluate/text_lines.h"

namespace maploop::match {
namespace {

std::string extension_of(std::filesystem::path file) {
  if (file.extension() == ".gz") file.replace_extension();
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

}  // namespace

Track read_track(const std::filesystem::path& file, const TrackOptions& options) {
  if (evaluation::is_lcm_log(file)) return read_log_track(file);
  const std::string text = evaluation::read_text(file);
  const std::string name = file.string();
  const std::string extension = extension_of(file);
  Track track;
  if (extension == ".gpx" || text.substr(0, 512).find("<gpx") != std::string::npos) {
    track = parse_gpx_track(text, name, options);
  } else if (extension == ".nmea" || text.starts_with("$G")) {
    track = parse_nmea_track(text, name, options);
  } else if (extension == ".tum") {
    track = parse_tum_track(text, name, options);
  } else {
    track = parse_csv_track(text, name, options);
  }
  if (track.empty()) throw std::runtime_error(name + " has no fix");
  return track;
}

void keep(const mapmatch::VehicleFix& fix, std::string_view name, Track& track) {
  if (track.size() == input_limits::fixes) {
    throw std::runtime_error(std::string(name) + ": more than " +
                             std::to_string(input_limits::fixes) + " fixes; cut it into parts");
  }
  track.push_back(fix);
}

namespace {

// Takes an offset from UTC, such as +02:00, off the end of a date with a time.
std::optional<Duration> take_offset(std::string& date) {
  constexpr std::size_t size = 6;
  if (date.size() <= size || date.find(':') >= date.size() - size) return std::nullopt;
  const std::string_view offset = std::string_view(date).substr(date.size() - size);
  const auto two_digits = [&](std::size_t at) -> std::optional<int> {
    const char tens = offset[at], ones = offset[at + 1];
    if (tens < '0' || tens > '9' || ones < '0' || ones > '9') return std::nullopt;
    return 10 * (tens - '0') + ones - '0';
  };
  const auto hours = two_digits(1), minutes = two_digits(4);
  if ((offset[0] != '+' && offset[0] != '-') || offset[3] != ':' || !hours || !minutes)
    return std::nullopt;
  const Duration east = std::chrono::hours(*hours) + std::chrono::minutes(*minutes);
  const bool ahead = offset[0] == '+';
  date.resize(date.size() - size);
  return ahead ? east : -east;
}

}  // namespace

std::optional<Time> parse_track_time(std::string_view text) {
  if (const auto seconds = evaluation::number_of<double>(text)) {
    if (!std::isfinite(*seconds) || std::abs(*seconds) > 9e9) return {};
    return Time(from_seconds(*seconds));
  }
  std::string date(text);
  if (const auto t = date.find('T'); t != std::string::npos) date[t] = ' ';
  if (date.ends_with('Z')) date.pop_back();
  const std::optional<Duration> east = take_offset(date);
  try {
    return parse_time(date) - east.value_or(Duration::zero());
  } catch (const std::invalid_argument&) {
    return {};
  }
}

}  // namespace maploop::match
