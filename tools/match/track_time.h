// Times as track files write them.
#pragma once

#include <optional>
#include <string_view>

#include "msgs/time.h"

namespace maploop::match {

// Seconds ("12.5", also since 1970), or a date and time ("2011-09-26 13:10:51.17",
// "2011-09-26T13:10:51Z"); none where it is neither.
std::optional<Time> parse_track_time(std::string_view text);

}  // namespace maploop::match
