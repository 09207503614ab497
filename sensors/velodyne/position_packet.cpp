#include "sensors/velodyne/position_packet.h"

#include <string_view>

#include "sensors/gnss/nmea.h"

namespace maploop::sensors {
namespace {

std::optional<Time> rmc_time(std::string_view text) {
  const auto sentence = parse_nmea(text.substr(0, text.find('\r')));
  if (!sentence || sentence->kind != "RMC" || sentence->field(1) != "A") return {};
  const auto time = nmea_time_of_day(sentence->field(0));
  const auto date = nmea_date(sentence->field(8));
  if (!time || !date) return {};
  return *date + *time;
}

}  // namespace

std::optional<Time> PositionPacket::utc() const {
  if (!pulse_locked || !receiver_time) return {};
  constexpr Duration hour = std::chrono::hours(1);
  Time t = std::chrono::floor<std::chrono::hours>(*receiver_time) +
           std::chrono::microseconds(device_time);
  if (t - *receiver_time > hour / 2) t -= hour;
  if (*receiver_time - t > hour / 2) t += hour;
  return t;
}

std::optional<PositionPacket> parse_position_packet(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t time_at = 198, pulse_at = 202, text_at = 206, text_size = 128;
  if (bytes.size() != velodyne_position_size) return {};
  PositionPacket packet;
  for (std::size_t i = 4; i-- > 0;)
    packet.device_time = packet.device_time << 8 | bytes[time_at + i];
  packet.pulse_locked = bytes[pulse_at] == 2;
  packet.receiver_time =
      rmc_time({reinterpret_cast<const char*>(bytes.data()) + text_at, text_size});
  return packet;
}

}  // namespace maploop::sensors
