// Reads tracks in common file formats.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "msgs/local_frame.h"
#include "tools/match/csv_track.h"
#include "tools/match/track.h"

namespace maploop::match {

struct TrackFileOptions : TrackOptions {
  std::optional<Geodetic> origin;  // of a TUM trajectory's local east-north-up frame
};

// Reads CSV (csv_track.h), GPX track points, NMEA 0183 (RMC, GGA, GST), TUM poses or an LCM log;
// plain or .gz, distinguished by name and content. Throws std::runtime_error naming the file, the
// line if there is one, and what to do.
Track read_track(const std::filesystem::path& file, const TrackFileOptions& options);

Track parse_gpx_track(std::string_view text, std::string_view name, const TrackOptions& options);
// Skips sentences with a wrong checksum. Throws std::runtime_error if the file has no position.
Track parse_nmea_track(std::string_view text, std::string_view name, const TrackOptions& options);
Track parse_tum_track(std::string_view text, std::string_view name,
                      const TrackFileOptions& options);

// Reads a log of `maploop replay --record` or lcm-logger: the fused states, ten a second, or the
// GNSS fixes if there are no states. Throws std::runtime_error if the log is damaged.
Track read_log_track(const std::filesystem::path& file);

}  // namespace maploop::match
