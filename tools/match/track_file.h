// Tracks in the files that users have.
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

// CSV (csv_track.h), GPX track points, NMEA 0183 (RMC, GGA, GST), TUM poses, an LCM log; plain or
// .gz, told apart by name and content. Throws std::runtime_error naming the file, the line where
// there is one, and what to do.
Track read_track(const std::filesystem::path& file, const TrackFileOptions& options);

Track parse_gpx_track(std::string_view text, std::string_view name, const TrackOptions& options);
// A sentence whose checksum is wrong is passed over; a file without a position is refused.
Track parse_nmea_track(std::string_view text, std::string_view name, const TrackOptions& options);
Track parse_tum_track(std::string_view text, std::string_view name,
                      const TrackFileOptions& options);

// Of `maploop replay --record` or lcm-logger: the fused states, ten a second, or the GNSS fixes
// where there are none. A damaged log is refused.
Track read_log_track(const std::filesystem::path& file);

}  // namespace maploop::match
