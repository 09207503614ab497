#include "sensors/imu/imu_line.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "sensors/gnss/nmea.h"

namespace maploop::sensors {

std::optional<ImuLine> parse_imu_line(std::string_view line) {
  constexpr double largest_force = 500.0, largest_rate = 100.0, longest = 1e9;
  const auto sentence = parse_nmea(line);
  constexpr std::array largest{longest,       largest_force, largest_force, largest_rate,
                               largest_force, largest_rate,  largest_rate};
  constexpr std::size_t reduced = 4;
  if (!sentence || sentence->kind != "PIMU" ||
      (sentence->count != reduced && sentence->count != largest.size()))
    return {};
  std::array<double, largest.size()> v{};
  for (std::size_t i = 0; i < sentence->count; ++i) {
    const auto number = sentence->number(i);
    if (!number || std::abs(*number) > largest[i]) return {};
    v[i] = *number;
  }
  return ImuLine{from_seconds(v[0]),
                 {v[1], v[2], v[3], sentence->count == largest.size(), v[4], v[5], v[6]}};
}

std::string imu_line(const ImuLine& sample) {
  const InertialValues& v = sample.values;
  std::array<char, 160> text{};
  const auto size = static_cast<std::size_t>(
      std::snprintf(text.data(), text.size(), "PIMU,%.6f,%.6f,%.6f,%.8f", to_seconds(sample.time),
                    v.specific_force_forward, v.specific_force_left, v.yaw_rate));
  std::string body(text.data(), size);
  if (v.six_axes) {
    const auto more =
        static_cast<std::size_t>(std::snprintf(text.data(), text.size(), ",%.6f,%.8f,%.8f",
                                               v.specific_force_up, v.roll_rate, v.pitch_rate));
    body.append(text.data(), more);
  }
  return nmea_sentence(body);
}

}  // namespace maploop::sensors
