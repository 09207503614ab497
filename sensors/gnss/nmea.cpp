#include "sensors/gnss/nmea.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "msgs/frames.h"
#include "sensors/number.h"

namespace maploop::sensors {
namespace {

std::optional<double> fixed_number(std::string_view text) {
  return parse_number<double>(text, std::chars_format::fixed);
}

// Returns the value of `count` decimal digits at `from`.
std::optional<int> digits(std::string_view text, std::size_t from, std::size_t count) {
  if (from + count > text.size()) return {};
  int value = 0;
  for (const char c : text.substr(from, count)) {
    if (c < '0' || c > '9') return {};
    value = 10 * value + (c - '0');
  }
  return value;
}

unsigned checksum(std::string_view body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return sum;
}

// Returns the text between '$' and '*' if the two digits after that are its checksum.
std::optional<std::string_view> checked_body(std::string_view line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == '\n')) line.remove_suffix(1);
  if (line.size() < 7 || line.front() != '$' || line[line.size() - 3] != '*') return {};
  const std::string_view body = line.substr(1, line.size() - 4);
  if (std::any_of(body.begin(), body.end(), [](char c) { return c < ' ' || c > '~'; })) return {};
  const auto said = parse_number<unsigned>(line.substr(line.size() - 2), 16);
  return said == checksum(body) ? std::optional(body) : std::nullopt;
}

}  // namespace

std::optional<double> NmeaSentence::number(std::size_t i) const {
  return fixed_number(field(i));
}

std::optional<NmeaSentence> parse_nmea(std::string_view line) {
  std::optional<std::string_view> body = checked_body(line);
  if (!body) return {};
  NmeaSentence sentence;
  const std::size_t first = body->find(',');
  const std::string_view name = body->substr(0, first);
  const bool standard = name.size() == 5 && name.front() != 'P';
  sentence.talker = standard ? name.substr(0, 2) : std::string_view();
  sentence.kind = standard ? name.substr(2) : name;
  for (std::size_t comma = first; comma != std::string_view::npos;) {
    if (sentence.count == NmeaSentence::max_fields) return {};
    const std::size_t next = body->find(',', comma + 1);
    sentence.fields[sentence.count++] = body->substr(
        comma + 1, next == std::string_view::npos ? std::string_view::npos : next - comma - 1);
    comma = next;
  }
  return sentence;
}

std::optional<Duration> nmea_time_of_day(std::string_view text) {
  const auto hours = digits(text, 0, 2), minutes = digits(text, 2, 2), seconds = digits(text, 4, 2);
  if (!hours || !minutes || !seconds || *hours > 23 || *minutes > 59 || *seconds > 60) return {};
  double fraction = 0.0;
  if (text.size() > 6) {
    const auto value = text[6] == '.' ? fixed_number(text.substr(6)) : std::optional(0.0);
    if (text[6] != '.' || (!value && text.size() > 7)) return {};
    fraction = value.value_or(0.0);
  }
  return std::chrono::hours(*hours) + std::chrono::minutes(*minutes) +
         std::chrono::seconds(*seconds) + from_seconds(fraction);
}

std::optional<Time> nmea_date(std::string_view text) {
  const auto day = digits(text, 0, 2), month = digits(text, 2, 2), year = digits(text, 4, 2);
  if (!day || !month || !year || text.size() != 6) return {};
  const std::chrono::year_month_day date{std::chrono::year(*year + (*year < 80 ? 2000 : 1900)),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return {};
  return Time(std::chrono::sys_days(date));
}

std::optional<double> nmea_angle(std::string_view text, std::string_view hemisphere) {
  const auto value = fixed_number(text);
  if (!value || *value < 0.0 || hemisphere.size() != 1) return {};
  const double whole = std::trunc(*value / 100.0), minutes = *value - 100.0 * whole;
  const char side = hemisphere.front();
  const double limit = side == 'N' || side == 'S'   ? 90.0
                       : side == 'E' || side == 'W' ? 180.0
                                                    : -1.0;
  const double angle = whole + minutes / 60.0;
  if (minutes >= 60.0 || angle > limit) return {};
  return radians(side == 'S' || side == 'W' ? -angle : angle);
}

std::string nmea_sentence(const std::string& body) {
  std::array<char, 16> end{};
  std::snprintf(end.data(), end.size(), "*%02X\r\n", checksum(body));
  return '$' + body + end.data();
}

// Rounded once, so that no 60 minutes come out.
std::string nmea_angle_fields(double angle, int degree_digits, const char* hemispheres) {
  constexpr long long per_minute = 10'000'000, per_degree = 60 * per_minute;
  const long long all = std::llround(std::abs(degrees(angle)) * 60.0 * per_minute);
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%0*lld%02lld.%07lld,%c", degree_digits, all / per_degree,
                all % per_degree / per_minute, all % per_minute, hemispheres[angle < 0.0 ? 1 : 0]);
  return text.data();
}

}  // namespace maploop::sensors
