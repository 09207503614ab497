#include "msgs/time.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace maploop {
namespace {

[[noreturn]] void reject(std::string_view text) {
  throw std::invalid_argument("not a time stamp of the form YYYY-MM-DD hh:mm:ss[.fraction]: '" +
                              std::string(text) + "'");
}

// Returns the decimal number in text[from, from + digits), or rejects the whole text.
int number(std::string_view text, std::size_t from, std::size_t digits) {
  int value = 0;
  for (std::size_t i = from; i < from + digits; ++i) {
    if (i >= text.size() || text[i] < '0' || text[i] > '9') reject(text);
    value = 10 * value + (text[i] - '0');
  }
  return value;
}

}  // namespace

Duration checked_seconds(double seconds) {
  constexpr double longest = 7.3e9;  // 231 years
  if (!(std::abs(seconds) < longest))
    throw std::invalid_argument(std::to_string(seconds) + " s is no time of a recording");
  return from_seconds(seconds);
}

Time parse_time(std::string_view text) {
  constexpr std::size_t whole = 19;  // YYYY-MM-DD hh:mm:ss
  if (text.size() < whole || text[4] != '-' || text[7] != '-' ||
      (text[10] != ' ' && text[10] != 'T') || text[13] != ':' || text[16] != ':') {
    reject(text);
  }
  const std::chrono::year_month_day date{
      std::chrono::year(number(text, 0, 4)),
      std::chrono::month(static_cast<unsigned>(number(text, 5, 2))),
      std::chrono::day(static_cast<unsigned>(number(text, 8, 2)))};
  const int hours = number(text, 11, 2);
  const int minutes = number(text, 14, 2);
  const int seconds = number(text, 17, 2);
  // The range of years keeps every stamp, and the difference of any two, within 64 bits.
  if (!date.ok() || date.year() < std::chrono::year(1970) ||
      date.year() > std::chrono::year(2200) || hours > 23 || minutes > 59 || seconds > 60) {
    reject(text);
  }

  std::int64_t fraction = 0;
  if (text.size() > whole) {
    const std::size_t digits = text.size() - whole - 1;
    if (text[whole] != '.' || digits == 0 || digits > 9) reject(text);
    fraction = number(text, whole + 1, digits);
    for (std::size_t i = digits; i < 9; ++i) fraction *= 10;
  }
  return std::chrono::sys_days(date) + std::chrono::hours(hours) + std::chrono::minutes(minutes) +
         std::chrono::seconds(seconds) + Duration(fraction);
}

std::string format_time(Time t) {
  const auto day = std::chrono::floor<std::chrono::days>(t);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(t - day);
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%04d-%02u-%02u %02d:%02d:%02d.%09lld",
                static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                static_cast<unsigned>(date.day()), static_cast<int>(time.hours().count()),
                static_cast<int>(time.minutes().count()), static_cast<int>(time.seconds().count()),
                static_cast<long long>(time.subseconds().count()));
  return text.data();
}

}  // namespace maploop
