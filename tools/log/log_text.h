// Formats and parses times, sizes and names for the log tools.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace maploop::lcm_log {

// Returns for instance "2011-09-26 13:10:51.175862", or "123 us" outside of the years 1970 to 2200.
std::string time_text(std::int64_t time_us);

// Returns for instance "1.4 MB".
std::string size_text(std::uint64_t bytes);

// Returns b - a in seconds: the nearest double (0.05 for 50000 us) for the years 1684 to 2255,
// without overflow outside of them.
double seconds_between(std::int64_t a_us, std::int64_t b_us);

}  // namespace maploop::lcm_log
