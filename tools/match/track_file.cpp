#include "tools/match/track_file.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string>

#include "tools/evaluate/text_file.h"
#include "tools/match/log_messages.h"

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

Track read_track(const std::filesystem::path& file, const TrackFileOptions& options) {
  if (is_lcm_log(file)) return read_log_track(file);
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

}  // namespace maploop::match
