#include "sensors/imu/imu_line.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "sensors/gnss/nmea.h"

namespace maploop::sensors {

std::optional<ImuLine> parse_imu_line(std::string_view line) {
  constexpr double largest_force = 500.0, largest_rate = 100.0, longest = 1e9;
  const auto sentence = parse_nmea(line);
  if (!sentence || sentence->kind != "PIMU" || sentence->count != 4) return {};
  const auto time = sentence->number(0), forward = sentence->number(1), left = sentence->number(2),
             rate = sentence->number(3);
  if (!time || !forward || !left || !rate || std::abs(*time) > longest ||
      std::abs(*forward) > largest_force || std::abs(*left) > largest_force ||
      std::abs(*rate) > largest_rate)
    return {};
  return ImuLine{from_seconds(*time), *forward, *left, *rate};
}

std::string imu_line(const ImuLine& sample) {
  std::array<char, 160> text{};
  const int size =
      std::snprintf(text.data(), text.size(), "PIMU,%.6f,%.6f,%.6f,%.8f", to_seconds(sample.time),
                    sample.specific_force_forward, sample.specific_force_left, sample.yaw_rate);
  return nmea_sentence(std::string(text.data(), static_cast<std::size_t>(size)));
}

}  // namespace maploop::sensors
