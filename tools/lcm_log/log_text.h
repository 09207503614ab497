// Times, sizes and names as the log tools show and read them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace maploop::lcm_log {

// "2011-09-26 13:10:51.175862"; "123 us" where that is not within the years 1970 to 2200.
std::string time_text(std::int64_t time_us);

// "1.4 MB".
std::string size_text(std::uint64_t bytes);

// b - a in seconds: the double nearest to it (0.05 for 50000 us) for the years 1684 to 2255, no
// overflow beyond.
double seconds_between(std::int64_t a_us, std::int64_t b_us);

// A line of a table or list, as printf would write it.
[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...);

}  // namespace maploop::lcm_log
