#include "ppp/satellite.h"

namespace maploop::ppp {
namespace {
constexpr std::string_view letters = "GRECJSI";
}

char letter(System system) {
  return letters[static_cast<std::size_t>(system)];
}

std::optional<System> system_of(char c) {
  const auto at = letters.find(c);
  if (at == std::string_view::npos) return {};
  return static_cast<System>(at);
}

std::optional<Satellite> parse_satellite(std::string_view text) {
  if (text.size() != 3) return {};
  const auto system = system_of(text[0] == ' ' ? 'G' : text[0]);
  const char tens = text[1] == ' ' ? '0' : text[1];
  const char ones = text[2];
  if (!system || tens < '0' || tens > '9' || ones < '0' || ones > '9') return {};
  const int number = (tens - '0') * 10 + (ones - '0');
  if (number == 0) return {};
  return Satellite{*system, static_cast<std::uint8_t>(number)};
}

std::string to_string(Satellite s) {
  return {letter(s.system), static_cast<char>('0' + s.number / 10),
          static_cast<char>('0' + s.number % 10)};
}

double carrier_frequency(System system, char band, std::optional<int> channel) {
  constexpr double mhz = 1e6;
  if (system == System::glonass) {
    if (band == '3') return 1202.025 * mhz;
    if (band == '4') return 1600.995 * mhz;
    if (band == '6') return 1248.06 * mhz;
    if (!channel) return 0.0;
    if (band == '1') return (1602.0 + *channel * 0.5625) * mhz;
    if (band == '2') return (1246.0 + *channel * 0.4375) * mhz;
    return 0.0;
  }
  if (system == System::beidou) {
    switch (band) {
      case '1':
        return 1575.42 * mhz;
      case '2':
        return 1561.098 * mhz;
      case '5':
        return 1176.45 * mhz;
      case '6':
        return 1268.52 * mhz;
      case '7':
        return 1207.14 * mhz;
      case '8':
        return 1191.795 * mhz;
      default:
        return 0.0;
    }
  }
  if (system == System::navic && band == '9') return 2492.028 * mhz;
  switch (band) {
    case '1':
      return 1575.42 * mhz;
    case '2':
      return system == System::gps || system == System::qzss ? 1227.60 * mhz : 0.0;
    case '5':
      return 1176.45 * mhz;
    case '6':
      return system == System::galileo || system == System::qzss ? 1278.75 * mhz : 0.0;
    case '7':
      return system == System::galileo ? 1207.14 * mhz : 0.0;
    case '8':
      return system == System::galileo ? 1191.795 * mhz : 0.0;
    default:
      return 0.0;
  }
}

std::array<char, 2> bands_of(System system) {
  switch (system) {
    case System::galileo:
      return {'1', '5'};
    case System::beidou:
      return {'2', '6'};
    case System::sbas:
    case System::navic:
      return {'1', '5'};
    default:
      return {'1', '2'};
  }
}

}  // namespace maploop::ppp
