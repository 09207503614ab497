#include "tools/log/log_text.h"

#include <fmt/format.h>
#include <array>

#include "msgs/time.h"

namespace maploop::lcm_log {

std::string time_text(std::int64_t time_us) {
  constexpr std::int64_t kYear2200 = 7'258'118'400'000'000;
  if (time_us < 0 || time_us >= kYear2200) return std::to_string(time_us) + " us";
  const std::string nanoseconds = format_time(from_nanoseconds(time_us * 1000));
  return nanoseconds.substr(0, nanoseconds.size() - 3);
}

std::string size_text(std::uint64_t bytes) {
  constexpr std::array<const char*, 4> kUnits{"kB", "MB", "GB", "TB"};
  if (bytes < 1000) return std::to_string(bytes) + " B";
  double value = static_cast<double>(bytes) / 1000.0;
  std::size_t unit = 0;
  while (value >= 999.95 && unit + 1 < kUnits.size()) {
    value /= 1000.0;
    ++unit;
  }
  return fmt::format("{:.1f} {}", value, kUnits[unit]);
}

double seconds_between(std::int64_t a_us, std::int64_t b_us) {
  return (static_cast<double>(b_us) - static_cast<double>(a_us)) / 1e6;
}

}  // namespace maploop::lcm_log
