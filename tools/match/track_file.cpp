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

std::optional<Time> parse_track_time(std::string_view text) {
  if (const auto seconds = evaluation::number_of<double>(text)) {
    if (!std::isfinite(*seconds) || std::abs(*seconds) > 9e9) return {};
    return Time(from_seconds(*seconds));
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
