// Parses the times of track files.
#pragma once

#include <optional>
#include <string_view>

#include "msgs/time.h"

namespace maploop::match {

// Parses seconds ("12.5", also since 1970), or a date and time ("2011-09-26 13:10:51.17",
// "2011-09-26T13:10:51Z"); returns nothing for other texts.
std::optional<Time> parse_track_time(std::string_view text);

}  // namespace maploop::match
