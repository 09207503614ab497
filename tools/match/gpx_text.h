// The text of GPX 1.1 files (topografix.com/GPX/1/1).
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "msgs/frames.h"
#include "tools/match/track_file.h"

namespace maploop::match {

// Track segments follow.
inline std::string gpx_begin(std::string_view name) {
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<gpx version=\"1.1\" creator=\"maploop\" "
      "xmlns=\"http://www.topografix.com/GPX/1/1\">\n<trk><name>{}</name>\n",
      name);
}

inline std::string gpx_point(const Geodetic& place, Time time) {
  std::string utc = format_time(time);
  utc[utc.find(' ')] = 'T';
  return fmt::format("<trkpt lat=\"{:.9f}\" lon=\"{:.9f}\"><time>{}Z</time></trkpt>\n",
                     degrees(place.latitude), degrees(place.longitude), utc);
}

inline constexpr std::string_view gpx_end = "</trk>\n</gpx>\n";

}  // namespace maploop::match
