// The fused state in the files that others read.
#pragma once

#include <filesystem>
#include <string>

#include "msgs/gnss.h"
#include "tools/replay/fusion_score.h"

namespace maploop::tools {

// A heading, then a line every 100 ms: stamp (s since 1970), status, latitude and longitude (deg),
// height, east, north, up (m), velocities (m/s), azimuth, pitch, roll (deg), forward speed, gyro
// bias (deg/h), the standard deviations of position, speed over ground and azimuth, and the ages of
// the aids inside (s; empty: never). Throws std::runtime_error naming the file.
void write_nav_csv(const std::filesystem::path& file, const fusion_score::NavTrack& track);

// NMEA 0183, once a second: GGA (quality 6, dead reckoning, where no fix is younger than 2 s), RMC,
// GST and HDT, talker GN. Times are the stamps' own. Throws std::runtime_error naming the file.
void write_nmea(const std::filesystem::path& file, const fusion_score::NavTrack& track);

// A fix as a receiver says it: GST, GGA (height above the ellipsoid, no geoid; of a single
// receiver, HDOP 1) and RMC, of its stamp to the hundredth of a second.
std::string nmea_sentences(const GnssFix& fix);

}  // namespace maploop::tools
