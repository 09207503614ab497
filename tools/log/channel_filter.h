// Selects the channels that a command works on.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace maploop::lcm_log {

using ChannelFilter = std::function<bool(std::string_view channel)>;

// Selects the channels whose whole name the regular expression (POSIX extended) matches. Throws
// std::invalid_argument stating its error.
ChannelFilter matching(const std::string& pattern);

}  // namespace maploop::lcm_log
